// mirrorball info: what is in a file.
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

int run(const Input& input, const Shared& shared) {
    const FileFacts facts = examine(input, shared);
    if (shared.json) {
        print_json(file_json(input.source, facts));
    } else {
        print(file_text(input.source, facts));
    }
    return 0;
}

}  // namespace

Command info_command(Shared& shared) {
    auto input = std::make_shared<Input>();
    Command command{.name = "info",
                    .summary = "What is in a map: size, projection, levels, range, flux, seams."};
    add_input_argument(command, *input);
    add_input_options(command, *input);
    add_shared_options(command, shared);
    command.notes = {
        "Flux is the integral of radiance over the sphere, per channel.",
        "A .hdr, .pfm or .exr panorama that is larger than --memory is read row by row."};
    command.examples = {"mirrorball info studio.hdr", "mirrorball info specular.ktx2 --json"};
    command.run = [input, &shared] { return run(*input, shared); };
    return command;
}

}  // namespace mirrorball::cli
