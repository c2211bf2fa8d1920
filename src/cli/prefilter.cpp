// mirrorball prefilter: an environment blurred by one lobe, or by one per level.
#include <memory>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/prefilter.h>

#include "chain.h"
#include "output.h"
#include "progress.h"
#include "targets.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

struct Options {
    Input input;
    std::string output, lobe, mapping;
    Projection projection = Projection::cube;
    int size = 0, levels = 0;
    bool reference = false;
    MapWriteOptions write;
};

constexpr int kUsualSize = 256, kUsualDiffuseSize = 64;

int usual_size(const std::string& lobe, Projection projection) {
    const int size = lobe == "diffuse" ? kUsualDiffuseSize : kUsualSize;
    return projection == Projection::equirect ? 4 * size : size;
}

std::vector<PrefilterTarget> targets_of(const Options& options) {
    const int size = options.size > 0 ? options.size : usual_size(options.lobe, options.projection);
    check_size(options.projection, size);
    const int levels = options.levels > 0 ? options.levels : usual_level_count(size);
    const auto lobes = parse_lobes(options.lobe, options.mapping, levels);
    if (lobes.size() > 1 && !holds_levels(options.output)) {
        throw Error(Errc::usage,
                    fmt::format("--lobe {} makes {} levels, {} holds one; .ktx2 and .dds "
                                "hold all",
                                options.lobe, lobes.size(), options.output));
    }
    return chain_targets(lobes, options.projection, size, default_axes(options.projection));
}

std::vector<EnvironmentMap> reference_levels(const EnvironmentMap& source,
                                             const std::vector<PrefilterTarget>& targets,
                                             ProgressBar& bar) {
    double texels = 0;
    for (const PrefilterTarget& target : targets)
        texels += static_cast<double>(target.size) * target.size;
    std::vector<EnvironmentMap> levels;
    for (const PrefilterTarget& target : targets) {
        const double share = static_cast<double>(target.size) * target.size / texels;
        levels.push_back(
            prefilter_reference(source, target, bar.stage(to_string(target.lobe), share)));
    }
    return levels;
}

int run(const Options& options, const Shared& shared) {
    check_target(options.output, options.write);
    const auto targets = targets_of(options);
    check_memory(
        bytes_needed(options.projection, targets.front().size, targets.size() > 1),
        fmt::format("projection {} at size {}", name(options.projection), targets.front().size),
        shared);
    const LoadedMap loaded = load(options.input, shared);
    EnvironmentMap result;
    {
        ProgressBar bar(shared);
        result = join_levels(options.reference
                                 ? reference_levels(loaded.map, targets, bar)
                                 : prefilter(loaded.map, targets, bar.stage("Prefiltering")));
    }
    print_written(options.output, result, write_map(options.output, result, options.write), shared);
    return 0;
}

}  // namespace

Command prefilter_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "prefilter",
                    .summary = "Blur an environment by a lobe, or by one lobe per level."};
    add_input_argument(command, options->input);
    command.options = {
        {"-o,--output", "FILE", output_help(), text(options->output), file_choices(), true},
        {"--lobe", "LOBE",
         "mirror, diffuse, phong:N, blinn-phong:N, ggx:ROUGHNESS, charlie:ROUGHNESS or table:FILE "
         "(lines of degrees and weight); ggx, phong or charlie alone is a whole chain, and a list "
         "(ggx:0.1,0.25,0.5) one lobe per level",
         text(options->lobe), lobe_choices(), true},
        {"--mapping", "PRESET", "of the chain's levels [gltf; playcanvas for phong]",
         text(options->mapping), mapping_choices()},
        {"--levels", "N", "of the chain [down to 16 texels]", whole_number(options->levels, 2, 21)},
        {"--to", "PROJECTION", "of the result [cube]",
         parsed(options->projection, parse_projection), projection_choices()},
        {"--size", "N", "edge of a face at level 0 [256; diffuse 64; an equirect 4 times that]",
         whole_number(options->size, 1, kLargestSize)},
        {"--reference", "", "sum over every source texel in double precision: the truth, slowly",
         flag(options->reference)}};
    add_input_options(command, options->input);
    add_write_options(command, options->write);
    add_shared_options(command, shared);
    command.notes = {
        "Level i of a chain has half the size of level i - 1. A lobe is about the "
        "reflection vector, diffuse about the normal; diffuse is irradiance, not "
        "divided by pi."};
    command.examples = {
        "mirrorball prefilter studio.hdr -o diffuse.ktx2 --lobe diffuse",
        "mirrorball prefilter studio.hdr -o specular.ktx2 --lobe ggx --mapping gltf",
        "mirrorball prefilter studio.hdr -o shiny.exr --lobe phong:100 --to equirect"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
