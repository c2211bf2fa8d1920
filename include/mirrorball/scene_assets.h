#pragma once
#include <map>
#include <string>
#include <mirrorball/environment_map.h>
#include <mirrorball/mesh.h>
namespace mirrorball {
struct SceneAssets {
    std::map<std::string, Mesh> meshes;
    std::map<std::string, Image> pictures;
    EnvironmentMap environment;
};
}
