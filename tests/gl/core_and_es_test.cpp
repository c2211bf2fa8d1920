// OpenGL and OpenGL ES show the same: one set of shaders, two languages.
#include <gtest/gtest.h>

#include "gl_test.h"

namespace mirrorball::gl {
namespace {

class CoreAndEs : public GlTest {};

TEST_F(CoreAndEs, ShowTheSame) {
    const auto assets = assets_in(smooth_environment());
    const int width = 128, height = 96;
    const auto pictures_with = [&](Api api) {
        use(api);
        Renderer renderer(assets);
        std::vector<Image> pictures;
        for (const Method method : all_methods()) {
            Scene scene = scene_with("torus", mirror_material(), method);
            if (method == Method::cube) {
                scene.objects[0].material = full_material();
                scene.lights = {ScenePointLight{{2, 3, 4}, {12, 10, 8}}};
            }
            pictures.push_back(renderer.picture(scene, {width, height, 1, true, {}}));
        }
        return pictures;
    };
    const std::vector<Image> core = pictures_with(Api::core), es = pictures_with(Api::es);
    for (std::size_t i = 0; i < core.size(); ++i) {
        double largest = 0;
        for (std::size_t k = 0; k < core[i].values().size(); ++k) {
            largest = std::max<double>(largest, std::abs(core[i].values()[k] - es[i].values()[k]));
        }
        // Both compile to the same operations, in what order is the driver's choice.
        EXPECT_LE(largest, 1.0 / 255) << name(all_methods()[i]);
    }
}

}  // namespace
}  // namespace mirrorball::gl
