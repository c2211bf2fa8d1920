// What tests of the renderer share: contexts that live as long as a suite, since each costs a tenth
// of a second, and scenes small enough for a processor that stands in for a graphics card.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <mirrorball/builtin.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/mesh.h>
#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

#include "synthetic.h"

namespace mirrorball::gl {

class GlTest : public ::testing::Test {
  protected:
    void SetUp() override { use(Api::core); }
    static void TearDownTestSuite() { contexts().clear(); }

    /// Makes the suite's context of this kind current.
    static void use(Api api) {
        std::unique_ptr<Context>& context = contexts()[api];
        if (context) {
            context->make_current();
        } else {
            context = std::make_unique<Context>(api);
        }
    }

  private:
    static std::map<Api, std::unique_ptr<Context>>& contexts() {
        static std::map<Api, std::unique_ptr<Context>> contexts;
        return contexts;
    }
};

/// A panorama of smooth_light(), which has no symmetry and no edge.
inline EnvironmentMap smooth_environment(int width = 128) {
    return sampled(Projection::equirect, width, smooth_light);
}

/// Drawn once.
inline const EnvironmentMap& builtin_environment(const std::string& name, int width = 128) {
    static std::map<std::pair<std::string, int>, EnvironmentMap> drawn;
    EnvironmentMap& map = drawn[{name, width}];
    if (map.levels.empty())
        map = make_builtin(name, Projection::equirect, width, default_axes(Projection::equirect));
    return map;
}

/// The environment and all built-in meshes.
inline std::shared_ptr<SceneAssets> assets_in(const EnvironmentMap& environment) {
    auto assets = std::make_shared<SceneAssets>();
    assets->environment = environment;
    for (const BuiltinMesh& mesh : builtin_meshes())
        assets->meshes[mesh.name] = make_mesh(mesh.name, mesh.name == "teapot" ? 8 : 16);
    return assets;
}

/// One object in the middle, seen a little from the right and from above. Shown as radiance times 1
/// by the film-like curve.
inline Scene scene_with(const std::string& mesh, const Material& material, Method method) {
    Scene scene;
    scene.objects.push_back({mesh, mesh, {}, material, {}});
    scene.camera.eye = {1.5, 1, 4};
    scene.camera.field_of_view = 0.55;
    scene.method = method;
    scene.map_size = 32;
    scene.exposure = 1;
    return scene;
}

/// All of the environment and nothing else.
inline Material mirror_material() {
    Material material;
    material.coupling = Coupling::added;
    return material;
}

inline Material diffuse_material() {
    Material material;
    material.coupling = Coupling::added;
    material.mirror = 0;
    material.diffuse = 1;
    return material;
}

/// One of every term.
inline Material full_material() {
    Material material;
    material.mirror = 0.4, material.glossy = 0.5, material.diffuse = 0.6;
    material.transmission = 0.5;
    material.emission = 0.25;
    material.base_color = {0.9, 0.6, 0.3};
    material.fresnel = Fresnel::dielectric(1.5);
    return material;
}

/// Radiance, one sample a pixel.
inline Image radiance(Renderer& renderer, const Scene& scene, int width, int height) {
    return renderer.picture(scene, {width, height, 1, false, {}});
}

/// What a screen gets of linear light y, 0 to 1: the sRGB curve.
inline double srgb(double y) {
    return y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055;
}

}  // namespace mirrorball::gl
