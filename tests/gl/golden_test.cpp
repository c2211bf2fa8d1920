// Small pictures of the past. Drivers round and filter differently, so what is compared is the root
// mean square over the picture, of sRGB values from 0 to 255.
//
// tests/golden/README.md says how they are made anew.
#include <cstdlib>

#include <gtest/gtest.h>
#include <mirrorball/io.h>

#include "bumpy_assets.h"
#include "gl_test.h"

namespace mirrorball::gl {
namespace {

constexpr int kWidth = 160, kHeight = 90, kSamples = 4;

// A pixel of a silhouette that falls to the other side is off by some 60 of 255 in one sample of
// four; a hundredth of all pixels are such, which comes to 1.5. A driver that filters by other
// weights is off by less than 1 everywhere. A wrong sign, frame or map is off by 10 and more.
constexpr double kTolerance = 2;

struct GoldenPicture {
    std::string name;
    Scene scene;
};

std::vector<GoldenPicture> golden_pictures() {
    std::vector<GoldenPicture> pictures;
    const auto add = [&](const std::string& name, const std::string& mesh, const Material& material,
                         Method method) -> Scene& {
        Scene scene = scene_with(mesh, material, method);
        scene.exposure = 0;
        scene.map_size = 64;
        pictures.push_back({name, scene});
        return pictures.back().scene;
    };
    Material gold = mirror_material();
    gold.fresnel = Fresnel::conductor("gold");
    for (const Method method : all_methods())
        add("teapot-" + std::string(name(method)), "teapot", gold, method).camera.field_of_view =
            0.3;

    Material rough = gold;
    rough.mirror = 0, rough.glossy = 1, rough.coupling = Coupling::split_sum;
    rough.fresnel = Fresnel::conductor("copper");
    add("torus-copper", "torus", rough, Method::octahedral);
    Material plastic = full_material();
    plastic.emission = 0;
    plastic.transmission = 0;
    plastic.lobe = parse_lobe("phong:60");
    Scene& room = add("sphere-plastic-in-a-room", "sphere", plastic, Method::cube);
    room.lights = {ScenePointLight{{2, 3, 3}, {20, 18, 15}}};
    room.environment.proxy = BoxProxy{{-4, -1, -4}, {4, 3, 5}};
    room.environment.captured_at = {0, 0.5, 0};
    Material glass = mirror_material();
    glass.transmission = 1, glass.coupling = Coupling::layered;
    glass.fresnel = Fresnel::dielectric(1.5);
    Material dented = mirror_material();
    dented.fresnel = Fresnel::conductor("silver");
    dented.bump.source = "hammered", dented.bump.size = 128, dented.bump.repeat = {4, 2};
    add("sphere-hammered", "sphere", dented, Method::cube);
    Material bark = full_material();
    bark.emission = bark.transmission = bark.mirror = 0;
    bark.bump.source = "bark", bark.bump.size = 128, bark.bump.repeat = {3, 1};
    bark.bump.form = BumpForm::classic;
    bark.bump.luminance_scale = 0.6, bark.bump.luminance_offset = 0.4;
    add("torus-bark-classic", "torus", bark, Method::sphere).lights = {
        ScenePointLight{{3, 2, 3}, {20, 18, 15}}};
    add("cube-glass", "cube", glass, Method::dual_paraboloid).objects[0].transform.scale =
        Vec3d(0.7);
    return pictures;
}

std::filesystem::path golden_file(const std::string& name) {
    return std::filesystem::path(MIRRORBALL_SOURCE_DIR) / "tests" / "golden" / (name + ".png");
}

// Both are sRGB, of 8 bits in the file; read as linear light.
double rms_difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values().size(); ++i) {
        const double difference = 255 * (srgb(a.values()[i]) - srgb(b.values()[i]));
        sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(a.values().size()));
}

class Golden : public GlTest {};

TEST_F(Golden, PicturesAreAsTheyWere) {
    std::vector<BumpMap> bumps;
    for (const GoldenPicture& golden : golden_pictures())
        bumps.push_back(golden.scene.objects[0].material.bump);
    const auto assets = bumpy_assets(builtin_environment("sunset", 256), bumps);
    Renderer renderer(assets);
    const bool update = std::getenv("MIRRORBALL_UPDATE_GOLDEN") != nullptr;
    for (const GoldenPicture& golden : golden_pictures()) {
        const Image drawn = renderer.picture(golden.scene, {kWidth, kHeight, kSamples, true, {}});
        if (update) write_image(golden_file(golden.name), drawn);
        const Image kept = read_image(golden_file(golden.name));
        ASSERT_EQ(kept.width(), kWidth);
        ASSERT_EQ(kept.height(), kHeight);
        ASSERT_EQ(kept.channels(), 3);
        EXPECT_LE(rms_difference(drawn, kept), kTolerance) << golden.name;
    }
}

}  // namespace
}  // namespace mirrorball::gl
