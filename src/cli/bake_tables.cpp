// The files of a bake that do not depend on the environment: the DFG table and the Fresnel map.
#include <mirrorball/fresnel.h>

#include "bake.h"
#include "dfg_files.h"

namespace mirrorball::cli {
namespace {

constexpr int kFresnelSamples = 256;

const std::vector<DfgChannel>& channels() {
    using enum DfgChannel;
    static const std::vector<DfgChannel> all = {scale, bias, charlie};
    return all;
}

// Shared exponents and small floats are for colours; a table keeps 11 bits at least.
TexelFormat table_format(const BakeOptions& options) {
    return options.format == TexelFormat::rgba32f ? TexelFormat::rgba32f : TexelFormat::rgba16f;
}

}  // namespace

void make_tables(Bake& bake) {
    bake.dfg_file.image = dfg_image(*bake.dfg, channels());
    bake.dfg_file.metadata = dfg_metadata(channels());
    const FresnelMap fresnel(bake.options.fresnel, kFresnelSamples);
    bake.fresnel_file.image = fresnel.image();
    bake.fresnel_file.metadata = {{"mirrorball.table", "fresnel"},
                                  {"mirrorball.columns", "cos theta = x / (width - 1)"},
                                  {"mirrorball.surface", to_string(bake.options.fresnel)}};
}

void write_tables(Bake& bake, const std::filesystem::path& folder) {
    for (BakedTable* table : {&bake.dfg_file, &bake.fresnel_file}) {
        table->format = table_format(bake.options);
        WriteOptions options;
        options.format = table->format;
        options.metadata = table->metadata;
        table->written = write_image(folder / table->file, table->image, options);
    }
}

}  // namespace mirrorball::cli
