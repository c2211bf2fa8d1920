// mirrorball compare: how far apart two maps are, by solid angle.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/compare.h>
#include <mirrorball/error.h>
#include <mirrorball/resample.h>

#include "false_color.h"
#include "output.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

constexpr double kTolerance = 1e-3;
constexpr int kDifferent = 1;
constexpr int kAllLevels = -1;

struct Options {
    Input input;
    std::string a, b, picture;
    double tolerance = kTolerance;
    int level = 0;
};

Json to_json(int level, const Difference& d) {
    return {{"level", level},
            {"relative_rmse", d.relative_rmse},
            {"maximum", d.maximum},
            {"maximum_relative", d.maximum_relative},
            {"maximum_relative_at", {{"face", d.face}, {"x", d.x}, {"y", d.y}}},
            {"flux_ratio", cli::to_json(d.flux_ratio)}};
}

std::string to_text(int level, const Difference& d) {
    return fmt::format(
        "level {}\n"
        "  relative RMSE     {:.3e}\n"
        "  largest           {:.3e}\n"
        "  largest relative  {:.3e} at face {}, texel ({}, {})\n"
        "  flux A / flux B   {:.6f} {:.6f} {:.6f}\n",
        level, d.relative_rmse, d.maximum, d.maximum_relative, d.face, d.x, d.y, d.flux_ratio.x,
        d.flux_ratio.y, d.flux_ratio.z);
}

bool same_shape(const EnvironmentMap& a, const EnvironmentMap& b, int level) {
    return a.projection == b.projection && a.axes == b.axes && a.width(level) == b.width(level);
}

EnvironmentMap one_level(const EnvironmentMap& map, int level) {
    return {map.projection, map.axes, {map.levels[level]}};
}

// Each texel's relative difference (Difference::maximum_relative), on a logarithmic scale from 1e-4
// to 1.
EnvironmentMap picture(const EnvironmentMap& a, const EnvironmentMap& b, int level) {
    const EnvironmentMap tested =
        same_shape(a, b, level)
            ? one_level(a, level)
            : resample(one_level(a, level), b.projection, b.width(level), b.axes);
    EnvironmentMap result = one_level(b, level);
    const double floor = std::max(1e-2 * statistics(b, level).rms, 1e-30);
    for (std::size_t face = 0; face < result.levels[0].faces.size(); ++face) {
        Image& image = result.levels[0].faces[face];
        const Image& other = tested.levels[0].faces[face];
        for (int y = 0; y < image.height(); ++y) {
            for (int x = 0; x < image.width(); ++x) {
                double worst = 0;
                for (int c = 0; c < 3; ++c) {
                    const double reference = image.at(x, y)[c];
                    worst = std::max(worst, std::abs(other.at(x, y)[c] - reference) /
                                                std::max(reference, floor));
                }
                image.set_rgb(x, y, false_color(1 + std::log10(std::max(worst, 1e-30)) / 4));
            }
        }
    }
    return result;
}

int level_count(const EnvironmentMap& a, const EnvironmentMap& b) {
    if (a.level_count() == b.level_count()) return a.level_count();
    throw Error(Errc::usage, fmt::format("--level all: A has {} levels, B {}", a.level_count(),
                                         b.level_count()));
}

void check_level(int level, const EnvironmentMap& map, const std::string& file) {
    if (level < map.level_count()) return;
    throw Error(Errc::usage, fmt::format("--level: {} has levels 0 to {}, found {}", file,
                                         map.level_count() - 1, level));
}

int run(const Options& options, const Shared& shared) {
    if (!options.picture.empty()) check_target(options.picture, {});
    const EnvironmentMap a = load(options.a, options.input, shared).map;
    const EnvironmentMap b = load(options.b, options.input, shared).map;
    const bool all = options.level == kAllLevels;
    const int first = all ? 0 : options.level;
    const int last = all ? level_count(a, b) - 1 : options.level;
    check_level(last, a, options.a);
    check_level(last, b, options.b);

    double worst = 0;
    Json levels = Json::array();
    std::string text;
    for (int level = first; level <= last; ++level) {
        const Difference d = compare(a, b, level);
        // A map without light has no relative error; what differs from it differs by all.
        worst = std::max(
            worst, std::isnan(d.relative_rmse) ? (d.maximum > 0 ? HUGE_VAL : 0) : d.relative_rmse);
        levels.push_back(to_json(level, d));
        text += to_text(level, d);
    }
    if (!options.picture.empty()) write_map(options.picture, picture(a, b, first));
    const bool within = worst <= options.tolerance;
    text += fmt::format("{} the tolerance of {:g}\n", within ? "within" : "different: beyond",
                        options.tolerance);
    const Json json{{"a", options.a},
                    {"b", options.b},
                    {"levels", levels},
                    {"tolerance", options.tolerance},
                    {"within_tolerance", within}};
    shared.json ? print_json(json) : print(text);
    return within ? 0 : kDifferent;
}

}  // namespace

Command compare_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "compare", .summary = "How far apart two maps are, by solid angle."};
    command.arguments = {{"A", "the map tested", text(options->a), input_choices()},
                         {"B", "the reference; A is resampled to it where they differ in shape",
                          text(options->b), input_choices()}};
    command.options = {
        {"--tolerance", "T", "largest relative RMSE that counts as the same [1e-3]",
         real_number(options->tolerance, 0, HUGE_VAL)},
        {"--level", "L|all", "which level [0]",
         [options = options.get()](const std::string& typed) {
             options->level = typed == "all" ? kAllLevels : parse_whole_number(typed, 0, 31);
         }},
        {"--picture", "FILE", "the relative difference in false colours, 1e-4 black to 1 white",
         text(options->picture), file_choices()}};
    add_input_options(command, options->input);
    add_shared_options(command, shared);
    command.notes = {
        "Relative RMSE is sqrt(sum |A-B|^2 dw / sum |B|^2 dw) over the texels. The exit code is 0 "
        "within the tolerance and 1 beyond it."};
    command.examples = {"mirrorball compare ours.ktx2 theirs.dds --tolerance 2e-3",
                        "mirrorball compare a.ktx2 b.ktx2 --level all --json",
                        "mirrorball compare a.hdr b.hdr --picture difference.png"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
