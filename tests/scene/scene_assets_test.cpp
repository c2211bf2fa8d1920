// Loading what a scene names: from files and from nowhere, and what every failure is called.
#include <mirrorball/scene_assets.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include <mirrorball/error.h>
#include <mirrorball/lookup.h>

#include "support.h"

namespace mirrorball {
namespace {

void write_triangle(const std::filesystem::path& path) {
    std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
}

Scene small_scene() {
    Scene scene;
    scene.environment.source = "sky.hdr";
    return scene;
}

void write_sky(const std::filesystem::path& path) {
    Image image(8, 4, 3);
    for (float& value : image.values()) value = 1;
    image.set_rgb(4, 1, {2, 2, 2});
    write_image(path, image);
}

std::string refusal(const Scene& scene, const std::filesystem::path& folder,
                    const AssetOptions& options = {}) {
    try {
        (void)load_assets(scene, folder, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "not refused";
}

TEST(SceneAssets, FilesBesideTheScene) {
    const TemporaryFolder folder;
    write_sky(folder / "sky.hdr");
    write_triangle(folder / "a.obj");
    Image picture(2, 1, 1);
    *picture.at(0, 0) = 1;
    write_image(folder / "grey.pfm", picture);
    Scene scene = small_scene();
    scene.objects.resize(3);
    scene.objects[0].mesh = "a.obj";
    scene.objects[1].mesh = "a.obj";
    scene.objects[2].mesh = "torus";
    scene.objects[2].material.base_color_map = "grey.pfm";
    const SceneAssets assets = load_assets(scene, folder.path(), {.mesh_detail = 2});
    EXPECT_EQ(assets.meshes.size(), 2u);
    EXPECT_EQ(assets.meshes.at("a.obj").triangle_count(), 1u);
    EXPECT_EQ(assets.meshes.at("torus").positions, make_mesh("torus", 2).positions);
    EXPECT_EQ(assets.pictures.at("grey.pfm").channels(), 3);
    EXPECT_EQ(assets.pictures.at("grey.pfm").rgb(0, 0), Vec3f(1));
    EXPECT_EQ(assets.environment.width(), 8);
}

TEST(SceneAssets, BumpsAreSlopesAndTheirMeshesGetTangents) {
    const TemporaryFolder folder;
    write_sky(folder / "sky.hdr");
    Image heights(4, 2, 1);
    for (int x = 0; x < 4; ++x) *heights.at(x, 0) = *heights.at(x, 1) = static_cast<float>(x);
    write_image(folder / "ramp.pfm", heights);
    Scene scene = small_scene();
    scene.objects.resize(4);
    BumpMap& ramp = scene.objects[0].material.bump;
    ramp.source = "ramp.pfm", ramp.wrap = Wrap::clamp;
    ramp.height_scale = 0.1, ramp.width = 2;  // texels of half a metre
    scene.objects[1].material.bump.source = "builtin:bark";
    scene.objects[1].material.bump.size = 16;
    scene.objects[2].material.bump.source = "waves";
    scene.objects[3].mesh = "torus";
    const SceneAssets assets = load_assets(scene, folder.path(), {.mesh_detail = 2});
    EXPECT_EQ(assets.bumps.size(), 2u) << "what moves is made when it is asked for";
    EXPECT_FALSE(assets.meshes.at("sphere").tangents.empty());
    EXPECT_TRUE(assets.meshes.at("torus").tangents.empty());

    const auto texels = bump_texels(ramp, assets, 0);
    for (int x = 0; x < 4; ++x) {
        EXPECT_NEAR(texels->slopes.slopes.at(x, 1)[0], 0.2, 1e-6);
        EXPECT_NEAR(texels->slopes.slopes.at(x, 1)[1], 0, 1e-6);
        EXPECT_NEAR(*texels->heights.at(x, 0), x / 3.0, 1e-6);
    }
    const BumpMap& bark = scene.objects[1].material.bump;
    EXPECT_FALSE(moves(bark));
    EXPECT_EQ(bump_texels(bark, assets, 0), bump_texels(bark, assets, 7));
    const BumpMap& waves = scene.objects[2].material.bump;
    EXPECT_TRUE(moves(waves));
    const auto now = bump_texels(waves, assets, 0), later = bump_texels(waves, assets, 1);
    EXPECT_FALSE(std::equal(now->heights.values().begin(), now->heights.values().end(),
                            later->heights.values().begin()));
}

TEST(SceneAssets, LevelHeightsAreFlat) {
    const TemporaryFolder folder;
    write_sky(folder / "sky.hdr");
    write_image(folder / "level.pfm", Image(3, 5, 1));
    Scene scene = small_scene();
    scene.objects.resize(1);
    BumpMap& bump = scene.objects[0].material.bump;
    bump.source = "level.pfm";
    const SceneAssets assets = load_assets(scene, folder.path(), {.mesh_detail = 2});
    const auto texels = bump_texels(bump, assets, 0);
    for (const float slope : texels->slopes.slopes.values()) EXPECT_EQ(slope, 0);
    for (const float height : texels->heights.values()) EXPECT_EQ(height, 1);
}

TEST(SceneAssets, BumpsThatCannotBeAreRefused) {
    const TemporaryFolder folder;
    write_sky(folder / "sky.hdr");
    write_triangle(folder / "a.obj");
    write_image(folder / "grey.pfm", Image(4, 4, 1));
    Scene scene = small_scene();
    scene.objects.resize(1);
    scene.objects[0].name = "stone";
    BumpMap& bump = scene.objects[0].material.bump;
    const auto expect_refused = [&](const std::string& message, const AssetOptions& options = {}) {
        const std::string found = refusal(scene, folder.path(), options);
        EXPECT_NE(found.find("objects[0] \"stone\": "), std::string::npos) << found;
        EXPECT_NE(found.find(message), std::string::npos) << found;
    };
    bump.source = "wave";
    expect_refused("\"wave\" is no bump source; there are ");
    bump.source = "missing.png";
    expect_refused("missing.png");
    bump.source = "grey.pfm";
    bump.kind = BumpKind::normal;
    expect_refused("a picture of 1 channel is no normal map (3 were expected");
    bump.kind = BumpKind::slopes;
    expect_refused("a picture of 1 channel is no du/dv map (2 were expected");
    bump.kind.reset();
    scene.objects[0].mesh = "a.obj";
    expect_refused("a bump map needs texture coordinates, and a.obj has none");
    scene.objects[0].mesh = "sphere";
    bump.source = "waves", bump.size = 4096;
    expect_refused("waves: needs ", {.memory_limit = 1 << 20, .mesh_detail = 2});
}

TEST(SceneAssets, EnvironmentIsAsItsFileAndTheSceneTurnsIt) {
    const TemporaryFolder folder;
    write_sky(folder / "sky.hdr");
    Scene scene = small_scene();
    const Vec3d lamp = Vec3d(std::sin(kPi / 8) * std::sin(3 * kPi / 8), std::cos(3 * kPi / 8),
                             -std::cos(kPi / 8) * std::sin(3 * kPi / 8));
    EXPECT_EQ(look_up(load_assets(scene, folder.path()).environment, lamp), Vec3f(2));
    scene.environment.yaw = kPi / 2;  // what is ahead goes to the left
    scene.environment.intensity = 7;
    EnvironmentMap map = load_assets(scene, folder.path()).environment;
    EXPECT_EQ(look_up(map, lamp), Vec3f(2));
    map.axes = turned(map.axes, scene.environment);
    EXPECT_NEAR(look_up(map, {lamp.z, lamp.y, -lamp.x}).x, 2, 1e-5);
    EXPECT_LT(look_up(map, lamp).x, 1.5f);
}

TEST(SceneAssets, FailuresSayWhoWantedIt) {
    const TemporaryFolder folder;
    write_sky(folder / "sky.hdr");
    std::ofstream(folder / "broken.obj") << "f 1 2 3\n";
    Scene scene = small_scene();
    scene.objects.resize(2);
    scene.objects[1].name = "pot";
    const auto expect = [&](const std::string& message, const AssetOptions& options = {}) {
        const std::string found = refusal(scene, folder.path(), options);
        EXPECT_NE(found.find(message), std::string::npos) << found << "\nexpected " << message;
    };
    scene.objects[1].mesh = "none.obj";
    expect("objects[1] \"pot\": " + (folder / "none.obj").string());
    scene.objects[1].mesh = "broken.obj";
    expect("objects[1] \"pot\": " + (folder / "broken.obj").string());
    scene.objects[1].mesh = "teapod";
    expect("teapot");
    scene.objects[1].mesh = "cube";
    scene.objects[0].material.base_color_map = "none.png";
    expect("objects[0]: " + (folder / "none.png").string());
    scene.objects[0].material.base_color_map = "";
    expect("objects[0]: sphere: needs ", {.memory_limit = 100});
    scene.environment.source = "none.exr";
    expect("environment: " + (folder / "none.exr").string());
    scene.environment.source = "builtin:moon";
    expect("environment: ");
}

TEST(SceneAssets, SixFacesAreFoundBesideTheScene) {
    const TemporaryFolder folder;
    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"}) {
        Image image(2, 2, 3);
        for (float& value : image.values()) value = 0.5f;
        write_image(folder / (std::string(face) + ".hdr"), image);
    }
    Scene scene;
    scene.environment.source = "px.hdr,nx.hdr,py.hdr,ny.hdr,pz.hdr,nz.hdr";
    EXPECT_EQ(load_assets(scene, folder.path()).environment.projection, Projection::cube);
    scene.environment.source = "%s.hdr";
    EXPECT_EQ(load_assets(scene, folder.path()).environment.projection, Projection::cube);
}

}  // namespace
}  // namespace mirrorball
