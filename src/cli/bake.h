// What `mirrorball bake` makes, on its way from the options to the files and the report.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <mirrorball/dfg.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/io.h>
#include <mirrorball/nine_harmonics.h>

#include "options.h"
#include "output.h"
#include "plans.h"
#include "progress.h"

namespace mirrorball::cli {

struct BakeOptions {
    Input input;  ///< its source is the one that is being baked
    std::vector<std::string> sources;
    std::string output, mapping = "gltf";
    std::vector<Lobe> phong;
    int size = 256, level_count = 0, environment_size = 0, diffuse_size = 64;
    PrefilterOptions prefilter;
    Fresnel fresnel = Fresnel::dielectric(1.5);  ///< of the 1-D map
    TexelFormat format = TexelFormat::rgba16f;
    bool no_viewer = false;
    /// The script of the report's viewer, if there is to be one; and whether each report has a
    /// copy, or those of one folder share one.
    std::filesystem::path viewer_script = {};
    bool shared_viewer = false;
};

/// One level of a result, as figures.
struct LevelFacts {
    int level, size;
    std::optional<Lobe> lobe;
    LevelStatistics statistics;
    double seam_ratio;
    std::optional<double> estimated_error;  ///< of prefiltering
    /// This level's flux over what the source's flux should have become, per channel.
    Vec3d flux_ratio;
};

/// One file of the result.
struct BakedMap {
    std::string file, use;  ///< "specular.ktx2"; what a renderer does with it
    EnvironmentMap map;
    std::vector<double> estimated_errors;  ///< per level; empty where nothing is prefiltered
    std::vector<LevelFacts> facts;
    WriteReport written;
};

/// A file of the result that no environment changes.
struct BakedTable {
    std::string file, use;
    Image image;
    Metadata metadata;
    TexelFormat format = TexelFormat::automatic;
    WriteReport written;
};

struct Timing {
    std::string work;
    double seconds;
};

struct Bake {
    BakeOptions options;
    LoadedMap source;
    LevelStatistics source_statistics;
    BakedMap environment, specular, phong, diffuse;
    std::shared_ptr<const DfgTable> dfg;  ///< one for all inputs
    BakedTable dfg_file, fresnel_file;
    NineHarmonics radiance;
    double harmonics_error =
        0;                ///< of E(n) from nine coefficients, relative RMSE over the diffuse map
    double exposure = 1;  ///< of the pictures
    std::vector<Timing> timings;
};

/// Seconds since it was made or last asked.
class Stopwatch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What is prefiltered of any source: the levels of the specular chain, those of the Phong chain,
/// the irradiance (bake_maps.cpp).
[[nodiscard]] std::vector<PrefilterTarget> bake_targets(const BakeOptions& options);
/// Sets the size of the environment's faces where the options leave it to the source: its
/// resolution, or what `most_bytes` hold.
void choose_environment_size(Bake& bake, std::uint64_t most_bytes);
/// The maps, from the source.
void compute_maps(Bake& bake, Plans& plans, ProgressBar& bar);
/// The .ktx2 files; sets `written` of each map.
void write_maps(Bake& bake, const std::filesystem::path& folder);
/// The DFG table and the Fresnel map: as pictures with words, and as .ktx2 files (bake_tables.cpp).
void make_tables(Bake& bake);
void write_tables(Bake& bake, const std::filesystem::path& folder);
/// The tone-mapped PNGs that the report shows (bake_pictures.cpp).
void write_pictures(const Bake& bake, const std::filesystem::path& folder,
                    const Progress& progress);

/// bake.json and irradiance-sh.json (bake_json.cpp).
[[nodiscard]] Json bake_json(const Bake& bake);
[[nodiscard]] Json harmonics_json(const Bake& bake);

/// What the report's viewer reads and shows, and its script where it is not shared
/// (report_viewer.cpp). Nothing without options.viewer_script.
void write_viewer(const Bake& bake, const std::filesystem::path& folder);
/// Its section of the report; empty likewise.
[[nodiscard]] std::string viewer_section(const Bake& bake);
/// The script for several reports.
void write_viewer_script(const BakeOptions& options, const std::filesystem::path& folder);

/// index.html (report.cpp).
[[nodiscard]] std::string report_html(const Bake& bake);

inline constexpr const char* kPictureFolder = "pictures";

}  // namespace mirrorball::cli
