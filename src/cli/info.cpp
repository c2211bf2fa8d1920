// mirrorball info: what is in a file; and the projections compared, as measured.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>

#include "output.h"
#include "progress.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    Input input;
    bool projections = false;
    int size = 512;
};

// Projections
// ---------------------------------------------------------------------------------------

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

int print_projections(int size, const Shared& shared) {
    const double cube_pixels = measure(Projection::cube, size).pixels_per_degree;
    Json json = Json::array();
    std::string table =
        fmt::format("{:<22}{:>6}{:>10}{:>12}{:>10}{:>10}{:>9}{:>7}{:>7}\n", "projection", "faces",
                    "used", "large:small", "stretch", "pixels", "of cube", "seams", "poles");
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        stop_if_interrupted();
        const ProjectionFacts facts = measure(projection, size);
        json.push_back(facts_json(projection, facts, cube_pixels));
        table += row(projection, facts, cube_pixels);
    }
    if (shared.json) return print_json(Json{{"rows_per_face", size}, {"projections", json}}), 0;
    table += fmt::format(
        "\nMeasured over the texels of maps with {} rows a face.\n"
        "used         share of the pixels that hold a direction\n"
        "large:small  largest to smallest solid angle of a texel\n"
        "stretch      longest to shortest axis of a texel's footprint on the sphere, at its worst\n"
        "pixels       in all, so that nowhere two texels are more than 1 degree apart;\n"
        "of cube      the same over a cube's\n"
        "seams        edges where neighbours on the sphere are apart on the picture\n"
        "poles        edges or rims that are a single direction\n",
        size);
    print(table);
    return 0;
}

// Files
// ---------------------------------------------------------------------------------------------

// Where the picture's middle looks, in our world.
std::string direction_text(const Vec3d& d) {
    const struct {
        Vec3d axis;
        const char* name;
    } named[] = {{{1, 0, 0}, "+X (right)"}, {{-1, 0, 0}, "-X (left)"}, {{0, 1, 0}, "+Y (up)"},
                 {{0, -1, 0}, "-Y (down)"}, {{0, 0, 1}, "+Z (back)"},  {{0, 0, -1}, "-Z (ahead)"}};
    for (const auto& [axis, text] : named) {
        if (axis.dot(d) > 1 - 1e-9) return text;
    }
    return fmt::format("({:.3f}, {:.3f}, {:.3f})", d.x, d.y, d.z);
}

Vec3d centre_direction(const EnvironmentMap& map) {
    return visit(map.projection, [&](auto projection) {
        return map.axes.to_world(projection.direction(FacePoint<double>{0, 0.5, 0.5}));
    });
}

Json level_json(const EnvironmentMap& map, int level) {
    const LevelStatistics s = statistics(map, level);
    const auto& lobe = map.levels[level].lobe;
    return {{"level", level},
            {"width", map.width(level)},
            {"height", map.height(level)},
            {"lobe", lobe ? Json(to_string(*lobe)) : Json()},
            {"flux", to_json(s.flux)},
            {"minimum", to_json(s.minimum)},
            {"maximum", to_json(s.maximum)},
            {"rms", s.rms},
            {"seam_ratio", seam_ratio(map, level)},
            {"texels", s.texel_count},
            {"non_finite_texels", s.non_finite_count},
            {"negative_texels", s.negative_count}};
}

Json file_json(const std::string& source, const LoadedMap& loaded) {
    const EnvironmentMap& map = loaded.map;
    Json levels = Json::array();
    for (int i = 0; i < map.level_count(); ++i) levels.push_back(level_json(map, i));
    return {{"file", source},
            {"format", loaded.format},
            {"texel_format", name(loaded.stored)},
            {"projection", name(map.projection)},
            {"faces", face_count(map.projection)},
            {"width", map.width()},
            {"height", map.height()},
            {"axes", to_string(map.axes)},
            {"mirrored_axes", map.axes.mirrored()},
            {"centre_looks_at", to_json(centre_direction(map))},
            {"levels", levels},
            {"metadata", loaded.metadata},
            {"notes", loaded.notes}};
}

std::string level_text(const EnvironmentMap& map, int level) {
    const LevelStatistics s = statistics(map, level);
    const auto& lobe = map.levels[level].lobe;
    std::string text = fmt::format(
        "level {:<3}   {} x {}{}\n"
        "  range     {} to {}; rms {}\n"
        "  flux      {}\n"
        "  seams     {:.3f} (step across edges : step beside them)\n",
        level, map.width(level), map.height(level),
        lobe ? fmt::format(", filtered with {}", to_string(*lobe)) : std::string(),
        figures(Vec3d(s.minimum)), figures(Vec3d(s.maximum)), figure(s.rms), figures(s.flux),
        seam_ratio(map, level));
    if (s.negative_count > 0) text += fmt::format("  negative  {} texels\n", s.negative_count);
    if (s.non_finite_count > 0) text += fmt::format("  no number {} texels\n", s.non_finite_count);
    return text;
}

std::string file_text(const std::string& source, const LoadedMap& loaded) {
    const EnvironmentMap& map = loaded.map;
    std::string text = fmt::format(
        "{}\n"
        "format      {}, {}\n"
        "projection  {}\n"
        "axes        {}{}; the centre of {} looks at {}\n",
        source, loaded.format, name(loaded.stored), shape_text(map), to_string(map.axes),
        map.axes.mirrored() ? " (left-handed)" : "",
        face_count(map.projection) > 1 ? "the first face" : "the picture",
        direction_text(centre_direction(map)));
    for (int i = 0; i < map.level_count(); ++i) text += level_text(map, i);
    for (const std::string& note : loaded.notes) text += fmt::format("note        {}\n", note);
    return text;
}

int run(const Options& options, const Shared& shared) {
    if (options.projections) return print_projections(options.size, shared);
    Shared silent = shared;
    silent.quiet = true;  // the notes are part of the result
    const LoadedMap loaded = load(options.input, silent);
    if (shared.json) {
        print_json(file_json(options.input.source, loaded));
    } else {
        print(file_text(options.input.source, loaded));
    }
    return 0;
}

}  // namespace

Command info_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "info",
                    .summary = "What is in a map: size, projection, levels, range, flux, seams."};
    add_input_argument(command, options->input, false);
    command.options = {{"--projections", "", "compare the projections instead, as measured",
                        flag(options->projections)},
                       {"--size", "N", "rows of a face in that comparison [512]",
                        whole_number(options->size, 2, 8192)}};
    add_input_options(command, options->input);
    add_shared_options(command, shared);
    command.notes = {"Flux is the integral of radiance over the sphere, per channel."};
    command.examples = {"mirrorball info studio.hdr", "mirrorball info specular.ktx2 --json",
                        "mirrorball info --projections"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
