// mirrorball sky: built-in environments as files.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/builtin.h>
#include <mirrorball/error.h>

#include "output.h"
#include "progress.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    std::string name, output, axes;
    Projection projection = Projection::equirect;
    int size = 0;
    bool list = false;
    MapWriteOptions write;
};

int print_list(const Shared& shared) {
    Json json = Json::array();
    std::string text;
    for (const Builtin& builtin : builtins()) {
        json.push_back({{"name", builtin.name}, {"description", builtin.description}});
        text += fmt::format("{:<10}{}\n", builtin.name, builtin.description);
    }
    shared.json ? print_json(Json{{"environments", json}}) : print(text);
    return 0;
}

int default_size(Projection projection) {
    EnvironmentMap usual;  // an equirect of 1024, to be matched
    usual = make_environment_map(Projection::equirect, 1024);
    return size_that_keeps_resolution(usual, projection);
}

int run(const Options& options, const Shared& shared) {
    if (options.list) return print_list(shared);
    if (options.name.empty())
        throw Error(Errc::usage, "NAME is missing; see mirrorball sky --list");
    if (options.output.empty()) throw Error(Errc::usage, "--output FILE is missing");
    const int size = options.size > 0 ? options.size : default_size(options.projection);
    check_size(options.projection, size);
    check_memory(bytes_needed(options.projection, size, false), "the map", shared);
    check_target(options.output, options.write);

    const Axes axes = options.axes.empty() ? default_axes(options.projection)
                                           : parse_axes(options.axes, options.projection);
    ProgressBar bar(shared);
    const EnvironmentMap map =
        make_builtin(options.name, options.projection, size, axes, bar.stage("Drawing"));
    print_written(options.output, map, write_map(options.output, map, options.write), shared);
    return 0;
}

}  // namespace

Command sky_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "sky", .summary = "Built-in environments as files."};
    command.arguments = {{"NAME", "of the environment; --list shows them", text(options->name),
                          builtin_choices(), false}};
    command.options = {
        {"-o,--output", "FILE", output_help(), text(options->output), file_choices()},
        {"--list", "", "the environments there are", flag(options->list)},
        {"--to", "PROJECTION", "[equirect]", parsed(options->projection, parse_projection),
         projection_choices()},
        {"--size", "N", "edge in texels, an equirect's width [1024; cube 256]",
         whole_number(options->size, 1, kLargestSize)},
        {"--axes", "PRESET", "of the result: a program, or as +x+y-z [ours]", text(options->axes),
         axes_choices()}};
    add_write_options(command, options->write);
    add_shared_options(command, shared);
    command.examples = {"mirrorball sky sunset -o sunset.hdr --size 2048",
                        "mirrorball sky axes -o axes.ktx2 --to cube --size 512",
                        "mirrorball sky --list"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
