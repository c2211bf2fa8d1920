// mirrorball: finds the verb, runs it on the threads asked for, turns errors into exit codes.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <mirrorball/error.h>

#include "interrupt.h"
#include "output.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

std::vector<Command> all_commands(Shared& shared) {
    std::vector<Command> commands = {info_command(shared),        convert_command(shared),
                                     prefilter_command(shared),   irradiance_sh_command(shared),
                                     bake_command(shared),        compare_command(shared),
                                     sky_command(shared),         bump_command(shared),
                                     projections_command(shared), brdf_command(shared),
                                     fresnel_command(shared),     dfg_command(shared),
                                     view_stack_command(shared),  render_command(shared),
                                     view_command(shared),        compare_methods_command(shared),
                                     serve_command(shared)};
    commands.push_back(completion_command(shared, commands));
    return commands;
}

const Command& find_verb(const std::vector<Command>& commands, const std::string& name) {
    std::vector<std::string> names;
    for (const Command& command : commands) {
        if (command.name == name) return command;
        names.push_back(command.name);
    }
    throw Error(Errc::usage, unknown("a verb", name, names));
}

// TBB gives an arena no more threads than the whole program may have, so that is raised too.
int run_on_threads(int threads, const std::function<int()>& run) {
    if (threads == 0) return run();
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute(run);
}

int run(const std::vector<std::string>& arguments) {
    Shared shared;
    const std::vector<Command> commands = all_commands(shared);
    if (arguments.empty()) {
        fmt::print(stderr, "{}", help_text(commands));
        return kUsageExitCode;
    }
    const std::string& verb = arguments.front();
    if (verb == "--help" || verb == "-h") return print(help_text(commands)), 0;
    if (verb == "--version") return print("mirrorball " MIRRORBALL_VERSION "\n"), 0;

    const Command& command = find_verb(commands, verb);
    if (parse(command, {arguments.begin() + 1, arguments.end()}) == Parsed::help) {
        return print(help_text(command)), 0;
    }
    return run_on_threads(shared.threads, command.run);
}

int exit_code(const std::vector<std::string>& arguments) {
    try {
        return run(arguments);
    } catch (...) {
        const Failure failure = current_failure();
        tell_failure(failure);
        return failure.exit_code;
    }
}

}  // namespace
}  // namespace mirrorball::cli

int main(int argc, char** argv) {
    using namespace mirrorball;
    cli::watch_for_interrupts();
    const int code = cli::exit_code({argv + 1, argv + argc});
    cli::note_end_of_work();
    return code;
}
