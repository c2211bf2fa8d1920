// mirrorball irradiance-sh: an environment's diffuse light in nine coefficients per channel.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/nine_harmonics.h>
#include <mirrorball/zonal.h>

#include "output.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    Input input;
    HarmonicScale scale = HarmonicScale::irradiance;
    Window window = Window::none;
};

// What is summed to what, for each scale.
const char* formula(HarmonicScale scale) {
    switch (scale) {
        case HarmonicScale::radiance:
            return "L_lm; times Y_lm: the radiance, blurred";
        case HarmonicScale::irradiance:
            return "A_l L_lm; times Y_lm: the irradiance E(n)";
        case HarmonicScale::outgoing:
            return "A_l L_lm / pi; times Y_lm: what a white matte surface shows, E(n) / pi";
        case HarmonicScale::polynomial:
            return "A_l L_lm k_lm / pi; times the polynomials alone: E(n) / pi";
        case HarmonicScale::filament:
            return "A_l L_lm k_lm / pi; for IndirectLight::Builder::irradiance(3, sh)";
        case HarmonicScale::three_js:
            return "L_lm; for LightProbe.sh.coefficients";
        case HarmonicScale::unity:
            return "A_l L_lm k_lm / pi with z negated; for SphericalHarmonicsL2[channel, i]";
    }
    return "";
}

constexpr const char* kPolynomials[kNineHarmonics] = {"1",  "y",        "z",  "x",        "xy",
                                                      "yz", "3z^2 - 1", "xz", "x^2 - y^2"};

int degree(int i) {
    return i == 0 ? 0 : i < 4 ? 1 : 2;
}

NineHarmonics windowed(NineHarmonics harmonics, Window window) {
    const std::vector<double> factors = window_coefficients(window, 3);
    for (int i = 0; i < kNineHarmonics; ++i) harmonics.coefficients[i] *= factors[degree(i)];
    return harmonics;
}

Json json_of(const NineHarmonics& harmonics, const Options& options) {
    Json coefficients = Json::array();
    for (int i = 0; i < kNineHarmonics; ++i) {
        const int l = degree(i);
        coefficients.push_back({{"l", l},
                                {"m", i - l * l - l},
                                {"polynomial", kPolynomials[i]},
                                {"rgb", to_json(harmonics.coefficients[i])}});
    }
    return {{"file", options.input.source},
            {"scale", name(options.scale)},
            {"formula", formula(options.scale)},
            {"window", options.window == Window::none      ? "none"
                       : options.window == Window::hanning ? "hanning"
                                                           : "lanczos"},
            {"coefficients", coefficients}};
}

std::string text_of(const NineHarmonics& harmonics, const Options& options) {
    std::string text =
        fmt::format("scale  {}: {}\n\n{:>2}{:>4}  {:<11}{:>15}{:>15}{:>15}\n", name(options.scale),
                    formula(options.scale), "l", "m", "polynomial", "red", "green", "blue");
    for (int i = 0; i < kNineHarmonics; ++i) {
        const int l = degree(i);
        const Vec3d& c = harmonics.coefficients[i];
        text += fmt::format("{:>2}{:>4}  {:<11}{:>15.7g}{:>15.7g}{:>15.7g}\n", l, i - l * l - l,
                            kPolynomials[i], c.x, c.y, c.z);
    }
    return text;
}

int run(const Options& options, const Shared& shared) {
    const LoadedMap loaded = load(options.input, shared);
    const NineHarmonics radiance = windowed(analyse_nine(loaded.map), options.window);
    const NineHarmonics harmonics = scaled(radiance, options.scale);
    if (shared.json)
        print_json(json_of(harmonics, options));
    else
        print(text_of(harmonics, options));
    return 0;
}

Choices scale_choices() {
    Choices choices{.values = {}, .closed = true};
    for (const HarmonicScale scale : harmonic_scales()) choices.values.emplace_back(name(scale));
    return choices;
}

Window parse_window(const std::string& text) {
    return text == "hanning" ? Window::hanning : text == "lanczos" ? Window::lanczos : Window::none;
}

}  // namespace

Command irradiance_sh_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "irradiance-sh",
                    .summary = "Diffuse light in nine spherical-harmonic coefficients."};
    add_input_argument(command, options->input);
    command.options = {
        {"--scale", "NAME", "what the numbers are to be multiplied with [irradiance]",
         parsed(options->scale, parse_harmonic_scale), scale_choices()},
        {"--window",
         "NAME",
         "soften the cut after three bands, against ringing [none]",
         parsed(options->window, parse_window),
         {{"none", "hanning", "lanczos"}, true}}};
    add_input_options(command, options->input);
    add_shared_options(command, shared);
    command.notes = {
        "L_lm are the radiance's coefficients in the real basis Y_lm = k_lm times polynomial, in "
        "our axes (right-handed, +Y up); A_l = pi, 2 pi / 3, pi / 4 makes them irradiance. k_lm = "
        "0.282095; 0.488603 (l = 1); 1.092548 (xy, yz, xz), 0.315392 (3z^2 - 1), 0.546274 "
        "(x^2 - y^2).",
        "three.js takes radiance and multiplies by A_l in its shaders; Filament and Unity want "
        "all constants folded in and E / pi."};
    command.examples = {"mirrorball irradiance-sh studio.hdr",
                        "mirrorball irradiance-sh studio.hdr --scale filament --json"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
