// mirrorball view-stack: an environment as a BRDF reflects it, one map per view.
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>
#include <mirrorball/resample.h>
#include <mirrorball/view_lobe.h>

#include "brdf_text.h"
#include "chain.h"
#include "interrupt.h"
#include "output.h"
#include "plans.h"
#include "progress.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    Input input;
    std::string output, brdf;
    int elevations = 8, azimuths = 1, size = 64, checks = 128;
    double tolerance = PrefilterOptions().tolerance;
    TexelFormat format = TexelFormat::rgba16f;
};

// What the fit is checked on: more texels would take longer and say the same.
constexpr int kCheckSize = 32;

double degrees(double radians) {
    return radians * 180 / kPi;
}

std::string file_name(const ViewStack& stack, std::size_t layer) {
    const auto count = static_cast<std::size_t>(stack.azimuth_count());
    return count == 1
               ? fmt::format("elevation-{:02}.ktx2", layer)
               : fmt::format("elevation-{:02}-azimuth-{:02}.ktx2", layer / count, layer % count);
}

std::vector<PrefilterTarget> targets_of(const ViewStack& stack, int size) {
    std::vector<PrefilterTarget> targets;
    for (const ViewLobe& lobe : stack.lobes())
        targets.push_back({lobe.lobe, Projection::cube, size, default_axes(Projection::cube)});
    return targets;
}

Json layer_json(const ViewStack& stack, std::size_t layer, double estimated_error) {
    const ViewLobe& lobe = stack.lobes()[layer];
    const int count = stack.azimuth_count(), i = static_cast<int>(layer);
    return {{"file", file_name(stack, layer)},
            {"view_to_normal_degrees", degrees(stack.elevation(i / count))},
            {"view_to_tangent_degrees", degrees(stack.azimuth(i % count))},
            {"axis", to_json(lobe.axis)},
            {"albedo", to_json(lobe.albedo)},
            {"mirror", to_json(lobe.mirror)},
            {"fit_error", lobe.fit_error},
            {"estimated_error", estimated_error}};
}

std::string text_of(const ViewStack& stack, const std::vector<double>& errors, double fit) {
    std::string text = fmt::format("{:<28}{:>9}{:>9}{:>9}   {:<26}{:>6}{:>10}\n", "file", "view",
                                   "tangent", "axis", "albedo", "fit", "estimate");
    for (std::size_t k = 0; k < stack.lobes().size(); ++k) {
        const ViewLobe& lobe = stack.lobes()[k];
        const int count = stack.azimuth_count(), i = static_cast<int>(k);
        text += fmt::format("{:<28}{:>8.1f}°{:>8.1f}°{:>8.1f}°   {:<26}{:>6.3f}{:>10.1e}\n",
                            file_name(stack, k), degrees(stack.elevation(i / count)),
                            degrees(stack.azimuth(i % count)),
                            degrees(std::acos(std::min(1.0, lobe.axis.z))), figures(lobe.albedo),
                            lobe.fit_error, errors[k]);
    }
    return text + fmt::format(
                      "shaded by these maps, surfaces are off by {:.2g} rms of the integral "
                      "over the environment\n",
                      fit);
}

int run(const Options& options, const Shared& shared) {
    const Brdf brdf = read_brdf(options.brdf);
    ProgressBar bar(shared);
    const ViewStack stack(brdf, options.elevations, options.azimuths, bar.stage("Fitting", 0.2));
    Plans plans(targets_of(stack, options.size), {options.tolerance});
    check_memory(2 * bytes_needed(plans.targets()), "the result", shared);
    TemporaryFolder folder(options.output);
    const EnvironmentMap source = load(options.input, shared).map;
    check_memory(kSourceWork * bytes_held(source) + 2 * bytes_needed(plans.targets()),
                 options.output, shared);
    Prefiltered result = plans.plan_for(source)(source, bar.stage("Prefiltering", 0.3));
    const EnvironmentMap small =
        resample(source, Projection::cube, kCheckSize, default_axes(Projection::cube));
    const double fit =
        measure_fit(small, brdf, stack, options.checks, bar.stage("Checking the fit", 0.5));
    MapWriteOptions write_options;
    write_options.format = options.format;
    Json layers = Json::array();
    for (std::size_t k = 0; k < result.maps.size(); ++k) {
        const std::string name = file_name(stack, k);
        const WriteReport report =
            write_map((folder.path() / name).string(), result.maps[k], write_options);
        bar.hide();
        tell_clipped(name, report, shared);
        layers.push_back(layer_json(stack, k, result.errors[k]));
    }
    const Json json = {{"brdf", to_string(brdf)},
                       {"elevations", options.elevations},
                       {"azimuths", options.azimuths},
                       {"fit_error", fit},
                       {"layers", layers}};
    write_text(folder.path() / "stack.json", json.dump(2) + "\n");
    stop_if_interrupted();
    folder.move_to(options.output);
    if (shared.json)
        print_json(json);
    else if (!shared.quiet)
        print(text_of(stack, result.errors, fit));
    return 0;
}

}  // namespace

Command view_stack_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "view-stack",
                    .summary = "Blur an environment by a BRDF, one map per view."};
    add_input_argument(command, options->input);
    command.options = {
        {"-o,--output", "DIR", "folder for the maps and stack.json; made when it is not there",
         text(options->output), file_choices(), true},
        {"--brdf", "BRDF", kBrdfHelp, text(options->brdf), brdf_choices(), true},
        {"--elevations", "N", "of the view, from the normal to 85 degrees off [8]",
         whole_number(options->elevations, 1, 64)},
        {"--azimuths", "N", "of the view to the tangent, for anisotropic BRDFs [1]",
         whole_number(options->azimuths, 1, 64)},
        {"--size", "N", "edge of a face [64]", whole_number(options->size, 1, kLargestSize)},
        {"--checks", "N", "views that the fit is compared at with the integral [128]",
         whole_number(options->checks, 1, 65536)},
        tolerance_option(options->tolerance),
        ktx2_format_option(options->format)};
    add_input_options(command, options->input);
    add_shared_options(command, shared);
    command.notes = {
        "To shade a view: take the two nearest elevations (and azimuths) of stack.json, turn their "
        "axes about the normal to the view's azimuth and blend them; look both maps up along the "
        "blended axis, multiply each by its albedo and blend those. Mirrors in the BRDF are not in "
        "the maps: `mirror` is what they add of the light from the mirrored view.",
        "`fit` is what a lobe is off by from the BRDF seen from there, over its own rms: "
        "highlights "
        "at grazing angles are streaks, which no lobe around an axis is. Sums of a diffuse and a "
        "glossy term fit better apart, each by itself.",
        "See docs/theory/brdf-prefiltering.md."};
    command.examples = {
        "mirrorball view-stack studio.hdr -o paint --brdf paint.binary",
        "mirrorball view-stack studio.hdr -o gold --brdf 'brushed gold' --azimuths 8 --size 32",
        "mirrorball view-stack builtin:sunset -o rough --brdf ggx:roughness=0.6 --elevations 16"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
