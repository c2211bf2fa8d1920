// mirrorball brdf: a BRDF's figures, its laws, and plots of it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/brdf_properties.h>
#include <mirrorball/error.h>

#include "brdf_plots.h"
#include "brdf_text.h"
#include "output.h"
#include "progress.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    std::string name, polar, hemisphere, albedo;
    std::vector<double> angles = {0, 30, 60, 80};
    bool check = false, list = false;
};

std::vector<double> parse_angles(const std::string& text) {
    std::vector<double> angles;
    for (const std::string& part : split(text, ','))
        angles.push_back(parse_real_number(part, 0, 89.9));
    if (angles.size() > 8)
        throw Error(Errc::usage, fmt::format("{} angles; there is room for 8", angles.size()));
    return angles;
}

int print_list(const Shared& shared) {
    if (shared.json) {
        Json models = Json::array(), presets = Json::array();
        for (const auto& [name, parameters, description] : brdf_models())
            models.push_back(
                {{"name", name}, {"parameters", parameters}, {"description", description}});
        for (const auto& [name, text, description] : brdf_presets())
            presets.push_back({{"name", name}, {"is", text}, {"description", description}});
        print_json(Json{{"models", models}, {"presets", presets}});
        return 0;
    }
    std::string text = "models, with their parameters' ranges and [defaults]:\n";
    for (const auto& [name, parameters, description] : brdf_models())
        text += fmt::format("  {:<14}{}\n{:16}{}\n", name, description, "", parameters);
    text += "\npresets, and what they stand for:\n";
    for (const auto& [name, is, description] : brdf_presets()) {
        // what is true of gold is true of all metals
        if (description != "a metal" || is.ends_with("=gold"))
            text += fmt::format("  {:<20}{}\n", name, is);
    }
    text += "\nmetals, each with these finishes:\n ";
    for (const Metal& metal : metals()) text += fmt::format(" {}", metal.name);
    print(text + "\n");
    return 0;
}

double degrees(double radians) {
    return radians * 180 / kPi;
}

Json to_json(const Integral& integral) {
    return {{"value", cli::to_json(integral.value)}, {"error", integral.error}};
}

Json to_json(const Violation& violation) {
    return {{"largest", violation.largest},
            {"error", violation.error},
            {"at", {{"wi", cli::to_json(violation.wi)}, {"wo", cli::to_json(violation.wo)}}}};
}

Json to_json(const Brdf& brdf, const BrdfProperties& p, const Options& options) {
    Json json = {{"brdf", to_string(brdf)}, {"mean_albedo", to_json(p.mean_albedo)}};
    for (const AlbedoPoint& point : p.albedo)
        json["albedo"].push_back({{"degrees", degrees(point.theta)},
                                  {"albedo", to_json(point.albedo)},
                                  {"uniform_light", to_json(point.furnace)}});
    if (options.check) {
        json["reciprocity"] = to_json(p.reciprocity);
        json["isotropy"] = to_json(p.isotropy);
        json["smallest"] = p.smallest;
        json["not_finite"] = p.not_finite_count;
        json["laws"] = {{"reciprocal", p.is_reciprocal()},
                        {"conserves_energy", p.conserves_energy()},
                        {"isotropic", p.is_isotropic()},
                        {"positive", p.is_positive()}};
    }
    return json;
}

std::string integral_text(const Integral& integral) {
    const Vec3d& v = integral.value;
    const bool grey = v.x == v.y && v.x == v.z;
    const std::string value =
        grey ? fmt::format("{:.5f}", v.x) : fmt::format("{:.5f} {:.5f} {:.5f}", v.x, v.y, v.z);
    return fmt::format("{} ± {:.0e}", value, integral.error);
}

std::string albedo_text(const BrdfProperties& p) {
    const bool same = p.is_reciprocal();
    std::string text =
        fmt::format("  {:>6}  {:<36}{}\n", "angle", "albedo", same ? "" : "in uniform light");
    for (const AlbedoPoint& point : p.albedo)
        text += fmt::format("  {:>5}°  {:<36}{}\n", fmt::format("{:g}", degrees(point.theta)),
                            integral_text(point.albedo), same ? "" : integral_text(point.furnace));
    return text + fmt::format("  {:>6}  {}\n", "mean", integral_text(p.mean_albedo));
}

std::string direction_text(const Vec3d& w) {
    return fmt::format("({:.3f}, {:.3f}, {:.3f})", w.x, w.y, w.z);
}

std::string violation_text(const Violation& v) {
    if (v.largest == 0) return "largest difference 0";
    return fmt::format("largest relative difference {:.2g} ± {:.0e}, light {} view {}", v.largest,
                       v.error, direction_text(v.wi), direction_text(v.wo));
}

std::string energy_text(const BrdfProperties& p) {
    const AlbedoPoint& brightest = p.brightest();
    return fmt::format("largest albedo {} at {:g}°", integral_text(brightest.albedo),
                       degrees(brightest.theta));
}

std::string check_text(const BrdfProperties& p) {
    const auto line = [](const char* law, bool kept, const std::string& figures) {
        return fmt::format("{:<13}{:<8}{}\n", law, kept ? "yes" : "NO", figures);
    };
    const std::string positive =
        fmt::format("smallest value {:.3g}, {} not finite", p.smallest, p.not_finite_count);
    return line("reciprocal", p.is_reciprocal(), violation_text(p.reciprocity)) +
           line("energy kept", p.conserves_energy(), energy_text(p)) +
           line("isotropic", p.is_isotropic(), violation_text(p.isotropy)) +
           line("positive", p.is_positive(), positive);
}

void print_figures(const Brdf& brdf, const Options& options, const Shared& shared) {
    ProgressBar bar(shared);
    const BrdfProperties properties = measure_brdf(brdf, {}, bar.stage("Measuring"));
    if (shared.json) return print_json(to_json(brdf, properties, options));
    print(fmt::format("{}\n{}{}", to_string(brdf), options.check ? check_text(properties) : "",
                      albedo_text(properties)));
}

int run(const Options& options, const Shared& shared) {
    if (options.list) return print_list(shared);
    if (options.name.empty())
        throw Error(Errc::usage, "NAME is missing; see mirrorball brdf --list");
    const Brdf brdf = read_brdf(options.name);
    bool plotted = false;
    const auto plot = [&](const std::string& file, const std::function<std::string()>& draw) {
        if (file.empty()) return;
        if (!file.ends_with(".svg"))
            throw Error(Errc::usage, fmt::format("{}: plots are .svg files", file));
        write_text(file, draw());
        if (!shared.json) print(fmt::format("{}\n", file));
        plotted = true;
    };
    plot(options.polar, [&] { return polar_plot(brdf, options.name, options.angles); });
    plot(options.hemisphere, [&] { return hemisphere_plot(brdf, options.name, options.angles); });
    plot(options.albedo, [&] { return albedo_plot(brdf, options.name); });
    if (!plotted || options.check || shared.json) print_figures(brdf, options, shared);
    return 0;
}

}  // namespace

Command brdf_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "brdf", .summary = "How a surface scatters light: figures and plots."};
    command.arguments = {{"NAME", "model, preset or sum; --list shows them", text(options->name),
                          brdf_choices(), false}};
    command.options = {
        {"--check", "", "reciprocity, energy, isotropy, positivity, measured",
         flag(options->check)},
        {"--plot", "FILE", "the BRDF in the plane of incidence, .svg", text(options->polar),
         file_choices()},
        {"--hemisphere", "FILE", "the lobe over the hemisphere, .svg", text(options->hemisphere),
         file_choices()},
        {"--angles", "LIST", "of incidence, in degrees, for both of these [0,30,60,80]",
         parsed(options->angles, parse_angles)},
        {"--albedo", "FILE", "the albedo by the angle of incidence, .svg", text(options->albedo),
         file_choices()},
        {"--list", "", "the models and presets there are", flag(options->list)}};
    add_shared_options(command, shared);
    command.notes = {
        "NAME is a model with its parameters, as ggx:roughness=0.3,metal=gold, a preset, as "
        "\"brushed "
        "gold\" or \"plastic, index 1.5\", a measured BRDF, as merl:FILE or table:FILE, or a sum "
        "of these, as \"0.5*lambert + 0.3*phong:50 + 0.2*mirror\".",
        "Errors after ± are the quadrature's. An albedo above 1 by more than they are, or a "
        "relative difference above 1e-6, breaks a law."};
    command.examples = {"mirrorball brdf phong-lewis:50 --check",
                        "mirrorball brdf \"brushed gold\" --plot lobes.svg --hemisphere gold.svg",
                        "mirrorball brdf plastic --albedo albedo.svg --check --json",
                        "mirrorball brdf --list"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
