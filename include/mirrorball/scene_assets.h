// SceneAssets: the meshes, pictures and environment that a scene names, loaded.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <mirrorball/baked_maps.h>
#include <mirrorball/bump.h>
#include <mirrorball/environment_map.h>
#include <mirrorball/image.h>
#include <mirrorball/io.h>
#include <mirrorball/mesh.h>
#include <mirrorball/progress.h>
#include <mirrorball/scene.h>

namespace mirrorball {

/// A bump map as surfaces look it up.
struct BumpTexels {
    SlopeMap slopes;
    Image heights;  ///< one channel, from 0, the lowest, to 1; one texel of 1 where none are known
};

/// By the names that the scene has for them.
struct SceneAssets {
    std::map<std::string, Mesh> meshes;     ///< with tangents where a bump map asks for them
    std::map<std::string, Image> pictures;  ///< linear, three channels
    /// Of those that do not move, by bump_key().
    std::map<std::string, std::shared_ptr<const BumpTexels>> bumps;
    /// As its file has it: the scene turns and scales it when it is drawn, by turned() and its
    /// intensity.
    EnvironmentMap environment;
    /// What is looked up of the environment but itself; nothing: it is prefiltered. Of the Renderer
    /// only.
    std::shared_ptr<const BakedMaps> baked = nullptr;
    /// DfgTable::image(), if it was made beforehand; likewise.
    std::shared_ptr<const Image> dfg = nullptr;
};

struct AssetOptions {
    std::uint64_t memory_limit = kUnlimitedMemory;  ///< bytes that all of them may hold
    int mesh_detail = 0;                            ///< of built-in meshes, as make_mesh() takes it
    int builtin_width = 0;  ///< of built-in environments, in texels; 0: as read_map() has them
    Progress reading = {};  ///< of the environment, as MapReadOptions has it
};

/// A mesh's name is one of builtin_meshes(), or a file like all others: relative to `folder`, that
/// of the scene's file. \throws Error naming the object or the environment, and what is wrong with
/// what it names
[[nodiscard]] SceneAssets load_assets(const Scene& scene, const std::filesystem::path& folder,
                                      const AssetOptions& options = {});

// The parts of it, for those who load again and again.

/// Has `assets` all that the scene names but the environment?
[[nodiscard]] bool is_loaded(const Scene& scene, const SceneAssets& assets);
/// What it has not got. \throws Error as above
void load_missing(SceneAssets& assets, const Scene& scene, const std::filesystem::path& folder,
                  const AssetOptions& options = {});
/// \throws Error as read_map() does
[[nodiscard]] LoadedMap load_environment(const SceneEnvironment& environment,
                                         const std::filesystem::path& folder,
                                         const AssetOptions& options = {});
/// The axes of a map of the environment as the scene turns it.
[[nodiscard]] Axes turned(const Axes& axes, const SceneEnvironment& environment);

/// Whether a bump map's source changes with time.
[[nodiscard]] bool moves(const BumpMap& bump);
/// What its texels depend on besides the time.
[[nodiscard]] std::string bump_key(const BumpMap& bump);
/// Those of a scene's bump map at a time; moving ones are made. \pre it has one, and its assets are
/// loaded
[[nodiscard]] std::shared_ptr<const BumpTexels> bump_texels(const BumpMap& bump,
                                                            const SceneAssets& assets, double time);

}  // namespace mirrorball
