// mirrorball info: what is in a file; and the projections compared, as measured.
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>
#include <mirrorball/row_reader.h>

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

// What is printed of a level, and of a file: of a map, or of rows that were never held together.
struct LevelFacts {
    int width, height;
    std::optional<Lobe> lobe;
    LevelStatistics statistics;
    std::optional<double> seam_ratio;  ///< needs the whole map
};

struct FileFacts {
    std::string format;
    TexelFormat stored;
    Projection projection;
    Axes axes;
    std::vector<LevelFacts> levels;
    Metadata metadata;
    std::vector<std::string> notes;
};

FileFacts facts_of(const LoadedMap& loaded) {
    const EnvironmentMap& map = loaded.map;
    FileFacts facts{loaded.format,   loaded.stored, map.projection, map.axes, {},
                    loaded.metadata, loaded.notes};
    for (int i = 0; i < map.level_count(); ++i)
        facts.levels.push_back({map.width(i), map.height(i), map.levels[i].lobe, statistics(map, i),
                                seam_ratio(map, i)});
    return facts;
}

FileFacts facts_of(RowReader& rows) {
    const LevelStatistics found = statistics(rows);  // first, for what it makes the notes say
    FileFacts facts{rows.format(),   rows.stored(), Projection::equirect, rows.axes(), {},
                    rows.metadata(), rows.notes()};
    facts.levels.push_back({rows.width(), rows.height(), rows.lobe(), found, std::nullopt});
    facts.notes.emplace_back("was read row by row, as --memory is less than the whole takes");
    return facts;
}

Vec3d centre_direction(const FileFacts& facts) {
    return visit(facts.projection, [&](auto projection) {
        return facts.axes.to_world(projection.direction(FacePoint<double>{0, 0.5, 0.5}));
    });
}

Json level_json(const LevelFacts& level, int number) {
    const LevelStatistics& s = level.statistics;
    return {{"level", number},
            {"width", level.width},
            {"height", level.height},
            {"lobe", level.lobe ? Json(to_string(*level.lobe)) : Json()},
            {"flux", to_json(s.flux)},
            {"minimum", to_json(s.minimum)},
            {"maximum", to_json(s.maximum)},
            {"rms", s.rms},
            {"seam_ratio", level.seam_ratio ? Json(*level.seam_ratio) : Json()},
            {"texels", s.texel_count},
            {"non_finite_texels", s.non_finite_count},
            {"negative_texels", s.negative_count}};
}

Json file_json(const std::string& source, const FileFacts& facts) {
    Json levels = Json::array();
    for (std::size_t i = 0; i < facts.levels.size(); ++i)
        levels.push_back(level_json(facts.levels[i], static_cast<int>(i)));
    return {{"file", source},
            {"format", facts.format},
            {"texel_format", name(facts.stored)},
            {"projection", name(facts.projection)},
            {"faces", face_count(facts.projection)},
            {"width", facts.levels[0].width},
            {"height", facts.levels[0].height},
            {"axes", to_string(facts.axes)},
            {"mirrored_axes", facts.axes.mirrored()},
            {"centre_looks_at", to_json(centre_direction(facts))},
            {"levels", levels},
            {"metadata", facts.metadata},
            {"notes", facts.notes}};
}

std::string level_text(const LevelFacts& level, std::size_t number) {
    const LevelStatistics& s = level.statistics;
    std::string text = fmt::format(
        "level {:<3}   {} x {}{}\n"
        "  range     {} to {}; rms {}\n"
        "  flux      {}\n",
        number, level.width, level.height,
        level.lobe ? fmt::format(", filtered with {}", to_string(*level.lobe)) : std::string(),
        figures(Vec3d(s.minimum)), figures(Vec3d(s.maximum)), figure(s.rms), figures(s.flux));
    if (level.seam_ratio)
        text += fmt::format("  seams     {:.3f} (step across edges : step beside them)\n",
                            *level.seam_ratio);
    if (s.negative_count > 0) text += fmt::format("  negative  {} texels\n", s.negative_count);
    if (s.non_finite_count > 0) text += fmt::format("  no number {} texels\n", s.non_finite_count);
    return text;
}

std::string file_text(const std::string& source, const FileFacts& facts) {
    const LevelFacts& base = facts.levels.front();
    std::string text = fmt::format(
        "{}\n"
        "format      {}, {}\n"
        "projection  {}\n"
        "axes        {}{}; the centre of {} looks at {}\n",
        source, facts.format, name(facts.stored),
        shape_text(facts.projection, base.width, base.height,
                   static_cast<int>(facts.levels.size())),
        to_string(facts.axes), facts.axes.mirrored() ? " (left-handed)" : "",
        face_count(facts.projection) > 1 ? "the first face" : "the picture",
        direction_text(centre_direction(facts)));
    for (std::size_t i = 0; i < facts.levels.size(); ++i) text += level_text(facts.levels[i], i);
    for (const std::string& note : facts.notes) text += fmt::format("note        {}\n", note);
    return text;
}

FileFacts examine(const Input& input, const Shared& shared) {
    MapReadOptions options = input.options;
    options.memory_limit = shared.memory_limit;
    if (auto rows = open_if_larger(source_of(input), options, shared.memory_limit))
        return facts_of(*rows);
    Shared silent = shared;
    silent.quiet = true;  // the notes are part of the result
    return facts_of(load(input, silent));
}

int run(const Options& options, const Shared& shared) {
    if (options.projections) return print_projections(options.size, shared);
    const FileFacts facts = examine(options.input, shared);
    if (shared.json) {
        print_json(file_json(options.input.source, facts));
    } else {
        print(file_text(options.input.source, facts));
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
    command.notes = {
        "Flux is the integral of radiance over the sphere, per channel.",
        "A .hdr, .pfm or .exr panorama that is larger than --memory is read row by row."};
    command.examples = {"mirrorball info studio.hdr", "mirrorball info specular.ktx2 --json",
                        "mirrorball info --projections"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
