// SceneAssets: the meshes, pictures and environment that a scene names, loaded.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <mirrorball/environment_map.h>
#include <mirrorball/image.h>
#include <mirrorball/io.h>
#include <mirrorball/mesh.h>
#include <mirrorball/scene.h>

namespace mirrorball {

/// By the names that the scene has for them.
struct SceneAssets {
    std::map<std::string, Mesh> meshes;
    std::map<std::string, Image> pictures;  ///< linear, three channels
    /// Turned as the scene says; its intensity is applied when shading.
    EnvironmentMap environment;
};

struct AssetOptions {
    std::uint64_t memory_limit = kUnlimitedMemory;  ///< bytes that all of them may hold
    int mesh_detail = 0;                            ///< of built-in meshes, as make_mesh() takes it
};

/// A mesh's name is one of builtin_meshes(), or a file like all others: relative to `folder`, that
/// of the scene's file. \throws Error naming the object or the environment, and what is wrong with
/// what it names
[[nodiscard]] SceneAssets load_assets(const Scene& scene, const std::filesystem::path& folder,
                                      const AssetOptions& options = {});

// The parts of it, for those who load again and again.

/// Meshes and pictures that the scene names and `assets` has not got. \throws Error as above
void load_missing(SceneAssets& assets, const Scene& scene, const std::filesystem::path& folder,
                  const AssetOptions& options = {});
/// The environment as its file has it, not turned yet. \throws Error as read_map() does
[[nodiscard]] LoadedMap load_environment(const SceneEnvironment& environment,
                                         const std::filesystem::path& folder,
                                         const AssetOptions& options = {});
/// The axes of such a map as the scene turns it.
[[nodiscard]] Axes turned(const Axes& axes, const SceneEnvironment& environment);

}  // namespace mirrorball
