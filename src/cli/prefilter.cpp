// mirrorball prefilter: an environment blurred by one lobe, or by one per level.
#include <memory>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/view_lobe.h>

#include "batch.h"
#include "brdf_text.h"
#include "chain.h"
#include "plans.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    Input input;
    std::vector<std::string> sources;
    std::string output, ending, lobe, mapping;
    Projection projection = Projection::cube;
    int size = 0, levels = 0;
    double view = -1;      // degrees to the normal, the usual where negative
    double tolerance = 0;  // the library's where 0
    bool reference = false;
    MapWriteOptions write;
};

constexpr int kUsualSize = 256, kUsualDiffuseSize = 64;
constexpr double kUsualView = 45;
constexpr std::string_view kBrdfPrefix = "brdf:";
constexpr const char* kUsualEnding = ".ktx2";

int usual_size(const std::string& lobe, Projection projection) {
    const int size = lobe == "diffuse" ? kUsualDiffuseSize : kUsualSize;
    return projection == Projection::equirect ? 4 * size : size;
}

// Where the results go, checked before any work.
Batch batch_of(const Options& options) {
    if (names_folder(options.output)) {
        const std::string ending = options.ending.empty() ? kUsualEnding : options.ending;
        check_format("result" + ending, options.write);
        return batch_into(options.output, options.sources, ending);
    }
    if (options.sources.size() > 1) {
        throw Error(Errc::usage,
                    fmt::format("--output: {} is one file for {} inputs; the name of a folder ends "
                                "in a slash",
                                options.output, options.sources.size()));
    }
    if (!options.ending.empty()) {
        throw Error(Errc::usage,
                    "--ending is for results in a folder; -o names a file, which has "
                    "its own");
    }
    check_target(options.output, options.write);
    return {{{options.sources.front(), options.output}}, ""};
}

// If the lobe is a BRDF seen from somewhere.
std::optional<ViewLobe> view_lobe_of(const Options& options) {
    if (!options.lobe.starts_with(kBrdfPrefix)) {
        if (options.view < 0) return {};
        throw Error(Errc::usage,
                    fmt::format("--view is for --lobe brdf:..., found --lobe {}", options.lobe));
    }
    const Brdf brdf = read_brdf(options.lobe.substr(kBrdfPrefix.size()));
    const double theta = (options.view < 0 ? kUsualView : options.view) * kPi / 180;
    const ViewLobe lobe = fit_view_lobe(brdf, {std::sin(theta), 0, std::cos(theta)});
    if (lobe.albedo == Vec3d(0)) {
        throw Error(Errc::usage, fmt::format("--lobe {}: nothing is reflected but by a mirror, "
                                             "which --lobe mirror is for",
                                             options.lobe));
    }
    return lobe;
}

// What the BRDF makes of uniform light, it makes of all.
void apply_albedo(const ViewLobe& lobe, EnvironmentMap& map) {
    for (Image& face : map.levels[0].faces) {
        const std::span<float> values = face.values();
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] *= static_cast<float>(lobe.albedo[static_cast<int>(i % 3)]);
    }
}

double axis_degrees(const ViewLobe& lobe) {
    return std::atan2(-lobe.axis.x, lobe.axis.z) * 180 / kPi;
}

std::string fit_text(const ViewLobe& lobe) {
    return fmt::format(
        "about an axis {:.1f}° off the normal, away from the view; times the albedo "
        "{}; off by {:.2g} of the BRDF's rms{}\n",
        axis_degrees(lobe), figures(lobe.albedo), lobe.fit_error,
        lobe.mirror == Vec3d(0) ? "" : "; without its mirror");
}

Json fit_json(const ViewLobe& lobe) {
    return {{"axis_degrees", axis_degrees(lobe)},
            {"albedo", to_json(lobe.albedo)},
            {"mirror", to_json(lobe.mirror)},
            {"fit_error", lobe.fit_error}};
}

std::vector<PrefilterTarget> targets_of(const Options& options, const Batch& batch,
                                        const std::optional<ViewLobe>& view) {
    const int size = options.size > 0 ? options.size : usual_size(options.lobe, options.projection);
    check_size(options.projection, size);
    const int levels = options.levels > 0 ? options.levels : usual_level_count(size);
    const auto lobes =
        view ? std::vector{view->lobe} : parse_lobes(options.lobe, options.mapping, levels);
    const std::string& output = batch.jobs.front().output;
    if (lobes.size() > 1 && !holds_levels(output)) {
        throw Error(Errc::usage,
                    fmt::format("--lobe {} makes {} levels, {} holds one; .ktx2 and .dds "
                                "hold all",
                                options.lobe, lobes.size(), output));
    }
    return chain_targets(lobes, options.projection, size, default_axes(options.projection));
}

PrefilterOptions prefilter_options(const Options& options) {
    if (options.tolerance == 0) return {};
    if (options.reference) {
        throw Error(Errc::usage, "--reference is exact, --tolerance is for the fast way; give one");
    }
    return {options.tolerance};
}

Prefiltered reference_levels(const EnvironmentMap& source, std::span<const PrefilterTarget> targets,
                             ProgressBar& bar) {
    double texels = 0;
    for (const PrefilterTarget& target : targets)
        texels += static_cast<double>(target.size) * target.size;
    Prefiltered result;
    for (const PrefilterTarget& target : targets) {
        const double share = static_cast<double>(target.size) * target.size / texels;
        result.maps.push_back(
            prefilter_reference(source, target, bar.stage(to_string(target.lobe), share)));
    }
    return result;
}

// "estimated error: 0 at level 0, ..."; nothing for the reference, which estimates nothing.
std::string error_text(const std::vector<double>& errors) {
    if (errors.empty()) return "";
    std::string text = errors.size() > 1 ? "estimated error, level by level:" : "estimated error:";
    for (const double error : errors) text += fmt::format(" {:.2g}", error);
    return text + "\n";
}

Json run_one(const Job& job, const Options& options, const std::optional<ViewLobe>& view,
             Plans& plans, ProgressBar& bar, const Shared& shared) {
    const std::uint64_t result_bytes = bytes_needed(plans.targets());
    const std::uint64_t source_bytes = (shared.memory_limit - result_bytes) / kSourceWork;
    const EnvironmentMap source =
        load(job.input, options.input, shared, shared.memory_limit - source_bytes).map;
    check_memory(kSourceWork * bytes_held(source) + result_bytes, job.output, shared);
    Prefiltered result = options.reference
                             ? reference_levels(source, plans.targets(), bar)
                             : plans.plan_for(source)(source, bar.stage("Prefiltering"));
    EnvironmentMap map = join_levels(std::move(result.maps));
    if (view) apply_albedo(*view, map);
    const WriteReport written = write_map(job.output, map, options.write);
    bar.hide();
    tell_clipped(job.output, written, shared);
    if (!shared.json && !shared.quiet)
        print(written_text(job.output, map, written) + error_text(result.errors) +
              (view ? fit_text(*view) : ""));
    Json json = to_json(job.output, map, written);
    if (!options.reference) json["estimated_errors"] = result.errors;
    if (view) json["brdf"] = fit_json(*view);
    return json;
}

int run(const Options& options, const Shared& shared) {
    const Batch batch = batch_of(options);
    const std::optional<ViewLobe> view = view_lobe_of(options);
    Plans plans(targets_of(options, batch, view), prefilter_options(options));
    check_memory(bytes_needed(plans.targets()), "the result", shared);
    return run_batch(batch, shared, [&](const Job& job, ProgressBar& bar) {
        return run_one(job, options, view, plans, bar, shared);
    });
}

}  // namespace

Command prefilter_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "prefilter",
                    .summary = "Blur an environment by a lobe, or by one lobe per level."};
    add_inputs_argument(command, options->sources);
    command.options = {
        {"-o,--output", "FILE", output_help() + "; or a folder, its name ends in a slash",
         text(options->output), file_choices(), true},
        {"--ending", ".EXT", "of the results' names in a folder [.ktx2]", text(options->ending)},
        {"--lobe", "LOBE",
         "mirror, diffuse, phong:N, blinn-phong:N, ggx:ROUGHNESS, charlie:ROUGHNESS or table:FILE "
         "(lines of degrees and weight); ggx, phong or charlie alone is a whole chain, and a list "
         "(ggx:0.1,0.25,0.5) one lobe per level; brdf:BRDF is what a view of it makes of light",
         text(options->lobe), lobe_choices(), true},
        {"--view", "DEGREES", "to the normal, for brdf: [45]", real_number(options->view, 0, 89)},
        {"--mapping", "PRESET", "of the chain's levels [gltf; playcanvas for phong]",
         text(options->mapping), mapping_choices()},
        {"--levels", "N", "of the chain [down to 16 texels]", whole_number(options->levels, 2, 21)},
        {"--to", "PROJECTION", "of the result [cube]",
         parsed(options->projection, parse_projection), projection_choices()},
        {"--size", "N", "edge of a face at level 0 [256; diffuse 64; an equirect 4 times that]",
         whole_number(options->size, 1, kLargestSize)},
        tolerance_option(options->tolerance),
        {"--reference", "", "sum over every source texel in double precision: the truth, slowly",
         flag(options->reference)}};
    add_input_options(command, options->input);
    add_write_options(command, options->write);
    add_shared_options(command, shared);
    command.notes = {
        "Level i of a chain has half the size of level i - 1. A lobe is about the "
        "reflection vector, diffuse about the normal; diffuse is irradiance, not "
        "divided by pi.",
        "brdf: takes what mirrorball brdf does, or a measured file, as a lobe about its own axis, "
        "which lies in the plane of view and normal and is printed; the map is the radiance that "
        "is "
        "reflected. Mirrors in it are left out. For all views at once: mirrorball view-stack.",
        kBatchNote,
        "The estimated error is of each level by itself, rms over rms; 0 where it is the source, "
        "resampled. See docs/theory/spectral-prefiltering.md."};
    command.examples = {
        "mirrorball prefilter studio.hdr -o diffuse.ktx2 --lobe diffuse",
        "mirrorball prefilter studio.hdr -o specular.ktx2 --lobe ggx --mapping gltf",
        "mirrorball prefilter skies/*.hdr -o specular/ --lobe ggx --tolerance 1e-3",
        "mirrorball prefilter studio.hdr -o shiny.exr --lobe phong:100 --to equirect",
        "mirrorball prefilter studio.hdr -o paint.ktx2 --lobe brdf:paint.binary --view 60",
        "mirrorball prefilter studio.hdr -o gold.ktx2 --lobe 'brdf:brushed gold'"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
