// mirrorball bake: everything that a renderer needs of an environment, and a report that shows it.
#include <algorithm>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>

#include "bake.h"
#include "batch.h"
#include "chain.h"
#include "interrupt.h"
#include "page_folder.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

constexpr std::size_t kMostPhong = 6;
constexpr int kDfgSize = 128;
constexpr const char* kViewerScript = "embed.js";  // in the page's folder

std::vector<Lobe> parse_exponents(const std::string& text) {
    std::set<double, std::greater<>> exponents;  // the sharpest first: it needs the largest level
    for (const std::string& part : split(text, ',')) {
        exponents.insert(parse_real_number(part, 1, 1e5));
    }
    if (exponents.size() > kMostPhong) {
        throw Error(Errc::usage, fmt::format("found {} exponents; at most {} levels fit a chain",
                                             exponents.size(), kMostPhong));
    }
    std::vector<Lobe> lobes;
    for (const double exponent : exponents) lobes.push_back({Lobe::Kind::phong, exponent});
    return lobes;
}

void write_json(const std::filesystem::path& path, const Json& json) {
    write_text(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void name_files(Bake& bake) {
    bake.environment.file = "environment.ktx2";
    bake.environment.use =
        "The environment itself as a cube, for backgrounds and mirrors; "
        "box-filtered mips.";
    bake.specular.file = "specular.ktx2";
    bake.specular.use = "Look up by the reflection vector, at the level of the roughness.";
    bake.phong.file = "phong.ktx2";
    bake.phong.use = "Look up by the reflection vector; one level per exponent.";
    bake.diffuse.file = "diffuse.ktx2";
    bake.diffuse.use = "Irradiance: look up by the normal, times albedo / pi.";
    bake.dfg_file.file = "dfg.ktx2";
    bake.dfg_file.use =
        "Look up by (n.v, roughness): R and G are what to scale F0 by and what to add, B is "
        "Charlie sheen's albedo.";
    bake.fresnel_file.file = "fresnel.ktx2";
    bake.fresnel_file.use =
        fmt::format("Look up by n.v: the share that {} mirrors.", to_string(bake.options.fresnel));
}

void print_result(const Bake& bake, const Shared& shared) {
    if (shared.json || shared.quiet) return;
    std::string text;
    for (const BakedMap* baked : {&bake.environment, &bake.specular, &bake.phong, &bake.diffuse}) {
        text += fmt::format("{:<20} {}, {}\n", baked->file, shape_text(baked->map),
                            bytes_text(baked->written.byte_count));
    }
    for (const BakedTable* table : {&bake.dfg_file, &bake.fresnel_file}) {
        text += fmt::format("{:<20} {} x {}, {}\n", table->file, table->image.width(),
                            table->image.height(), bytes_text(table->written.byte_count));
    }
    double seconds = 0;
    for (const Timing& timing : bake.timings) seconds += timing.seconds;
    text += fmt::format(
        "irradiance-sh.json   9 coefficients\n"
        "bake.json            all figures\n"
        "{}  open this to see it; {:.1f} s in all\n",
        (std::filesystem::path(bake.options.output) / "index.html").string(), seconds);
    print(text);
}

// While a map is written, there is a copy of it in the file's form.
constexpr std::uint64_t kResultWork = 2;

// What is known of the results' size before the source is.
std::uint64_t bytes_of_results(const BakeOptions& options, const Plans& plans) {
    return kResultWork * (bytes_needed(plans.targets()) +
                          bytes_needed(Projection::cube, options.environment_size, true));
}

// An environment whose size follows from the source gets half of what the other results leave.
void read_source(Bake& bake, const Plans& plans, const Shared& shared) {
    const std::uint64_t known = bytes_of_results(bake.options, plans);
    const std::uint64_t left = shared.memory_limit - known;
    const std::uint64_t source_share = bake.options.environment_size == 0 ? left / 2 : left;
    bake.source =
        load(bake.options.input, shared, shared.memory_limit - source_share / kSourceWork);
    const std::uint64_t held = known + kSourceWork * bytes_held(bake.source.map);
    const std::uint64_t rest = shared.memory_limit - std::min(held, shared.memory_limit);
    choose_environment_size(bake, rest / kResultWork);
    check_memory(bytes_of_results(bake.options, plans) + kSourceWork * bytes_held(bake.source.map),
                 bake.options.output, shared);
}

Json run_one(const Job& job, const BakeOptions& options, std::shared_ptr<const DfgTable> dfg,
             Plans& plans, ProgressBar& bar, const Shared& shared) {
    Bake bake;
    bake.options = options;
    bake.dfg = std::move(dfg);
    bake.options.input.source = job.input;
    bake.options.output = job.output;
    name_files(bake);
    TemporaryFolder folder(job.output);
    Stopwatch watch;
    read_source(bake, plans, shared);
    bake.timings.push_back({"reading", watch.lap()});
    compute_maps(bake, plans, bar);
    write_maps(bake, folder.path());
    make_tables(bake);
    write_tables(bake, folder.path());
    watch.lap();
    write_pictures(bake, folder.path(), bar.stage("Pictures", 0.2));
    bake.timings.push_back({"pictures", watch.lap()});
    if (!options.viewer_script.empty()) {
        write_viewer(bake, folder.path());
        bake.timings.push_back({"viewer", watch.lap()});
    }
    write_json(folder.path() / "irradiance-sh.json", harmonics_json(bake));
    write_json(folder.path() / "bake.json", bake_json(bake));
    write_text(folder.path() / "index.html", report_html(bake));
    stop_if_interrupted();
    folder.move_to(job.output);
    if (options.shared_viewer) {
        write_viewer_script(options, std::filesystem::path(job.output).parent_path());
    }
    bar.hide();
    for (const BakedMap* baked : {&bake.environment, &bake.specular, &bake.phong, &bake.diffuse}) {
        tell_clipped(baked->file, baked->written, shared);
    }
    print_result(bake, shared);
    return bake_json(bake);
}

int run(BakeOptions options, const Shared& shared) {
    if (const auto page = page_folder_with(kViewerScript); page && !options.no_viewer)
        options.viewer_script = *page / kViewerScript;
    options.shared_viewer = !options.viewer_script.empty() && options.sources.size() > 1;
    Plans plans(bake_targets(options), options.prefilter);
    check_memory(bytes_of_results(options, plans), "the result", shared);
    const Batch batch = options.sources.size() == 1
                            ? Batch{{{options.sources.front(), options.output}}, ""}
                            : batch_into(options.output, options.sources, "");
    const auto dfg = std::make_shared<const DfgTable>(kDfgSize, kDfgSize);
    return run_batch(batch, shared, [&](const Job& job, ProgressBar& bar) {
        return run_one(job, options, dfg, plans, bar, shared);
    });
}

}  // namespace

Command bake_command(Shared& shared) {
    auto options = std::make_shared<BakeOptions>();
    options->phong = parse_exponents("10,100,1000");
    Command command{
        .name = "bake",
        .summary = "All that a renderer needs of an environment, and a page that shows it."};
    add_inputs_argument(command, options->sources);
    command.options = {
        {"-o,--output", "DIR",
         "folder for the results; made when it is not there, as is one in it per input if there "
         "are "
         "several",
         text(options->output), file_choices(), true},
        {"--size", "N", "edge of a face of the specular chain [256]",
         whole_number(options->size, 16, kLargestSize)},
        {"--levels", "N", "of the specular chain [down to 16 texels]",
         whole_number(options->level_count, 2, 16)},
        {"--mapping", "PRESET", "of roughness to levels [gltf]", text(options->mapping),
         mapping_choices()},
        {"--phong", "N,N,...", "exponents, one level each; stored from the sharpest [10,100,1000]",
         parsed(options->phong, parse_exponents)},
        tolerance_option(options->prefilter.tolerance),
        {"--environment-size", "N", "edge of a face of the environment [keeps the resolution]",
         whole_number(options->environment_size, 1, kLargestSize)},
        {"--diffuse-size", "N", "edge of a face of the irradiance map [64]",
         whole_number(options->diffuse_size, 1, kLargestSize)},
        {"--fresnel", "SURFACE",
         "of the Fresnel map: index=N, metal=NAME, n=N,k=K or f0=F; under ,coat=N [index=1.5]",
         parsed(options->fresnel, parse_fresnel), surface_choices()},
        ktx2_format_option(options->format),
        {"--no-viewer", "", "leave out the live viewer on the page", flag(options->no_viewer)}};
    add_input_options(command, options->input);
    add_shared_options(command, shared);
    command.notes = {
        "DIR gets environment.ktx2 (cube with mips), specular.ktx2 (GGX, one level per roughness), "
        "phong.ktx2 (one level per exponent, each of half the size), diffuse.ktx2 (irradiance), "
        "dfg.ktx2 (split sum: scale, bias, sheen), fresnel.ktx2 (1-D), "
        "irradiance-sh.json (nine coefficients), bake.json (all figures) and index.html with its "
        "pictures. All of them appear together at the end, or none.",
        "Where the page for browsers is built (make web) or installed, index.html has a ball to "
        "turn, "
        "lit by what was baked, which viewer.js draws and maps.js lights; several results share "
        "one "
        "viewer.js beside them. --no-viewer leaves it out.",
        kBatchNote};
    command.examples = {"mirrorball bake studio.hdr -o studio",
                        "mirrorball bake builtin:sunset -o sunset --size 512 --mapping filament",
                        "mirrorball bake skies/*.hdr -o baked",
                        "mirrorball bake faces/%s.exr -o room --phong 20,200"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
