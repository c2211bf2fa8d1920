// What verbs that draw a scene have in common: a scene file, or one object put together by options.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

#include "command.h"
#include "options.h"

namespace mirrorball::cli {

/// Options are edits: of the whole scene, of its only object, of where the camera stands.
struct SceneInput {
    std::string file;  ///< empty: one object
    std::vector<std::function<void(Scene&)>> edits;
    std::string environment;  ///< empty: the file's, or the usual one
    std::string mesh, material;
    std::vector<std::function<void(Material&)>> material_edits;
    std::string camera;  ///< "YAW,PITCH[,DISTANCE]"; empty: the file's, or the usual one
    int width = 1280, height = 720;
};

/// SCENE, --mesh, --material, --env and the like.
void add_scene_argument(Command& command, SceneInput& input);
void add_scene_options(Command& command, SceneInput& input);
/// --width and --height.
void add_picture_size_options(Command& command, SceneInput& input);

/// The scene before anything that it names is loaded. \throws Error(Errc::usage) for options that
/// do not go together; what read_scene() throws
[[nodiscard]] Scene scene_of(const SceneInput& input);
/// Where names in the scene are those of files: only where there is a scene file is that beside it.
[[nodiscard]] std::filesystem::path folder_of(const SceneInput& input);
/// Where the options or, without a scene file, what is usual would have it.
void place_camera_as_asked(Scene& scene, const SceneAssets& assets, const SceneInput& input);

struct LoadedScene {
    Scene scene;
    std::shared_ptr<const SceneAssets> assets;
};
/// \throws Error(Errc::usage) for options that do not go together, or maps that need more than
/// --memory; what reading files throws
[[nodiscard]] LoadedScene load_scene(const SceneInput& input, const Shared& shared);

/// .exr, .hdr and .pfm hold radiance, all others what a screen shows.
[[nodiscard]] bool holds_radiance(const std::string& target);

}  // namespace mirrorball::cli
