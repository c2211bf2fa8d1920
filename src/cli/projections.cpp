// mirrorball projections: section 3 of the survey, measured and drawn.
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>

#include "output.h"
#include "progress.h"
#include "projection_plots.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    std::optional<Projection> projection;  // else all
    std::string plot;
    int size = 512;
};

std::vector<Projection> projections_of(const Options& options) {
    if (options.projection) return {*options.projection};
    std::vector<Projection> all;
    for (std::size_t i = 0; i < kProjectionCount; ++i) all.push_back(static_cast<Projection>(i));
    return all;
}

Json facts_json(Projection projection, const ProjectionFacts& facts, double cube_pixels) {
    return {{"projection", name(projection)},
            {"faces", face_count(projection)},
            {"used_share", facts.used_share},
            {"solid_angle_ratio", facts.solid_angle_ratio},
            {"worst_stretch", facts.worst_stretch},
            {"pixels_per_degree", facts.pixels_per_degree},
            {"pixels_relative_to_cube", facts.pixels_per_degree / cube_pixels},
            {"seams", facts.seam_count},
            {"poles", facts.pole_count}};
}

std::string row(Projection projection, const ProjectionFacts& facts, double cube_pixels) {
    return fmt::format("{:<22}{:>6}{:>8.2f} %{:>12.4g}{:>10.4g}{:>10.0f}{:>9.2f}{:>7}{:>7}\n",
                       name(projection), face_count(projection), facts.used_share * 100,
                       facts.solid_angle_ratio, facts.worst_stretch, facts.pixels_per_degree,
                       facts.pixels_per_degree / cube_pixels, facts.seam_count, facts.pole_count);
}

std::string legend(int size) {
    return fmt::format(
        "\nMeasured over the texels of maps with {} rows a face.\n"
        "used         share of the pixels that hold a direction\n"
        "large:small  largest to smallest solid angle of a texel\n"
        "stretch      longest to shortest axis of a texel's footprint on the sphere, at its worst\n"
        "pixels       in all, so that nowhere two texels are more than 1 degree apart;\n"
        "of cube      the same over a cube's\n"
        "seams        edges where neighbours on the sphere are apart on the picture\n"
        "poles        edges or rims that are a single direction\n",
        size);
}

void check_plot(const Options& options) {
    if (options.plot.empty()) return;
    if (!options.projection)
        throw Error(Errc::usage, "--plot draws one projection; expected its name, as sphere");
    if (!options.plot.ends_with(".svg"))
        throw Error(Errc::usage, fmt::format("{}: plots are .svg files", options.plot));
}

int run(const Options& options, const Shared& shared) {
    check_plot(options);
    const double cube_pixels = measure(Projection::cube, options.size).pixels_per_degree;
    Json json = Json::array();
    std::string table =
        fmt::format("{:<22}{:>6}{:>10}{:>12}{:>10}{:>10}{:>9}{:>7}{:>7}\n", "projection", "faces",
                    "used", "large:small", "stretch", "pixels", "of cube", "seams", "poles");
    for (const Projection projection : projections_of(options)) {
        stop_if_interrupted();
        const ProjectionFacts facts = measure(projection, options.size);
        json.push_back(facts_json(projection, facts, cube_pixels));
        table += row(projection, facts, cube_pixels);
        if (!options.plot.empty()) write_text(options.plot, projection_plot(projection, facts));
    }
    if (shared.json) {
        print_json(Json{{"rows_per_face", options.size}, {"projections", json}});
    } else {
        print(table + legend(options.size));
    }
    return 0;
}

}  // namespace

Command projections_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "projections",
                    .summary = "What each projection wastes, stretches and needs, as measured."};
    command.arguments = {
        {"NAME", "one of them; all when left out",
         [options](const std::string& text) { options->projection = parse_projection(text); },
         projection_choices(), false}};
    command.options = {{"--plot", "FILE", "of one: how directions land on its map, .svg",
                        text(options->plot), file_choices()},
                       {"--size", "N", "rows of a face at which it is measured [512]",
                        whole_number(options->size, 2, 8192)}};
    add_shared_options(command, shared);
    command.examples = {"mirrorball projections", "mirrorball projections cube --json",
                        "mirrorball projections sphere --plot sphere.svg"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
