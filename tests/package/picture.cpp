// The rendering example of docs/rendering.md, word for word.
#include <mirrorball/gl/context.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/io.h>
#include <mirrorball/material_presets.h>

using namespace mirrorball;

int main() {
    Scene scene;
    scene.environment.source = "builtin:studio";
    scene.objects.push_back({.name = "pot", .mesh = "teapot", .material = preset_material("gold")});
    const auto assets = std::make_shared<const SceneAssets>(load_assets(scene, "."));
    scene.camera = framing(bounds(assets->meshes.at("teapot")), 16.0 / 9);

    const gl::Context context;
    gl::Renderer renderer(assets);
    write_image("teapot.png", renderer.picture(scene, {.width = 640, .height = 360}));
}
