// mirrorball fresnel: the 1-D Fresnel map as a file, and its curve.
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/io.h>

#include "brdf_plots.h"
#include "output.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    std::string surface, output, plot;
    int samples = 256;
};

std::string csv(const FresnelMap& map) {
    std::string text = "cos_theta,r,g,b\n";
    const auto samples = map.samples();
    for (std::size_t i = 0; i < samples.size(); ++i)
        text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n",
                            static_cast<double>(i) / static_cast<double>(samples.size() - 1),
                            samples[i].x, samples[i].y, samples[i].z);
    return text;
}

// With as many digits as the format has: an error of 1e-6 should not drown in 8 bits or half
// floats.
void write(const std::string& target, const FresnelMap& map) {
    if (target.ends_with(".csv")) return write_text(target, csv(map));
    WriteOptions options;
    if (target.ends_with(".png")) options.format = TexelFormat::unorm16;
    if (target.ends_with(".exr")) options.format = TexelFormat::rgba32f;
    write_image(target, map.image(), options);
}

int run(const Options& options, const Shared& shared) {
    const Fresnel fresnel = parse_fresnel(options.surface);
    const FresnelMap map(fresnel, options.samples);
    const auto error = map.interpolation_error();
    if (!options.output.empty()) write(options.output, map);
    if (!options.plot.empty()) {
        if (!options.plot.ends_with(".svg"))
            throw Error(Errc::usage, fmt::format("{}: plots are .svg files", options.plot));
        write_text(options.plot, fresnel_plot(fresnel, options.surface));
    }
    if (shared.json) {
        print_json(Json{
            {"surface", to_string(fresnel)},
            {"normal", to_json(fresnel(1))},
            {"mean", to_json(fresnel.average())},
            {"samples", options.samples},
            {"interpolation_error",
             {{"largest", error.largest}, {"at_cosine", error.at_cosine}, {"rms", error.rms}}}});
        return 0;
    }
    std::string text = fmt::format("{}\n  {:>6}  F\n", to_string(fresnel), "angle");
    for (const double degrees : {0, 30, 45, 60, 75, 80, 85, 89})
        text +=
            fmt::format("  {:>5}°  {}\n", degrees, figures(fresnel(std::cos(degrees * kPi / 180))));
    text += fmt::format("  {:>6}  {}\n", "mean", figures(fresnel.average()));
    text += fmt::format(
        "{} samples over the cosine: off by {:.2g} at most (at {:.1f}°), {:.2g} rms\n",
        options.samples, error.largest, std::acos(error.at_cosine) * 180 / kPi, error.rms);
    print(text);
    return 0;
}

}  // namespace

Command fresnel_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "fresnel",
                    .summary = "How much a smooth surface mirrors, by angle: the 1-D Fresnel map."};
    command.arguments = {{"SURFACE", "index=N, metal=NAME, n=N,k=K or f0=F; under ,coat=N",
                          text(options->surface), surface_choices()}};
    command.options = {
        {"-o,--output", "FILE", "the map: one row of texels (.exr .png .ktx2 ...) or .csv",
         text(options->output), file_choices()},
        {"--samples", "N", "of the map [256]", whole_number(options->samples, 2, 65536)},
        {"--plot", "FILE", "the curve, .svg", text(options->plot), file_choices()}};
    add_shared_options(command, shared);
    command.notes = {
        "Sample i of N is F at the cosine i / (N - 1); as a texture with linear "
        "filtering, look up (cosine (N - 1) + 1/2) / N. EXR holds "
        "float32; PNG 16 bits with the sRGB curve, to be loaded as an sRGB texture.",
        "Three numbers for R, G and B are written 0.2/0.9/1.1."};
    command.examples = {"mirrorball fresnel index=1.5 -o fresnel.exr",
                        "mirrorball fresnel metal=gold --samples 64 -o gold.csv --plot gold.svg",
                        "mirrorball fresnel metal=copper,coat=1.5 --json"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
