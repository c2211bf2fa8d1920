// Frame times of every method: a teapot that fills most of the picture, a mirror, at 1280 x 720 and
// 1920 x 1080, nothing behind it. Frames of the same mesh in a constant colour are drawn in
// between: the ratio says more than milliseconds do, which are the machine's. Both are the quickest
// of all frames, since machines are shared; `Time` is the mean.
//
// A frame is drawn from scratch, maps that are made for the camera included, and waited for with
// glFinish. Runs on whatever EGL finds; which driver that is stands in the output, as `driver`.
#include <algorithm>
#include <chrono>
#include <memory>

#include <benchmark/benchmark.h>
#include <mirrorball/builtin.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/mesh.h>

#include "gl/gl.h"
#include "gl/target.h"

namespace mirrorball::gl {
namespace {

std::shared_ptr<const SceneAssets> teapot_at_sunset() {
    auto assets = std::make_shared<SceneAssets>();
    assets->meshes["teapot"] = make_mesh("teapot");
    assets->environment =
        make_builtin("sunset", Projection::equirect, 1024, default_axes(Projection::equirect));
    return assets;
}

Scene scene_with(const Material& material, Method method, double aspect) {
    Scene scene;
    scene.objects.push_back({"teapot", "teapot", {}, material, {}});
    scene.camera = framing(bounds(make_mesh("teapot", 4)), aspect);
    scene.method = method;
    scene.exposure = 1;
    scene.environment.background = false;
    return scene;
}

double seconds_of_frame(Renderer& renderer, const Scene& scene, const Target& target) {
    using Clock = std::chrono::steady_clock;
    target.bind();
    glFinish();
    const Clock::time_point start = Clock::now();
    renderer.draw(scene, target.width(), target.height());
    glFinish();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void frame(benchmark::State& state, const Material& material, Method method) {
    static const std::shared_ptr<const SceneAssets> assets = teapot_at_sunset();
    const int height = static_cast<int>(state.range(0)), width = height * 16 / 9;
    const double aspect = static_cast<double>(width) / height;
    Renderer renderer(assets), plain_renderer(assets);  // each keeps the maps of one method
    const Target target(width, height);

    Material constant_color;
    constant_color.mirror = 0;
    const Scene plain = scene_with(constant_color, Method::cube, aspect);
    const Scene scene = scene_with(material, method, aspect);
    // What is kept from frame to frame is made in the first.
    seconds_of_frame(plain_renderer, plain, target);
    seconds_of_frame(renderer, scene, target);

    double least = 1e9, least_plain = 1e9;
    for (auto _ : state) {
        least_plain = std::min(least_plain, seconds_of_frame(plain_renderer, plain, target));
        const double seconds = seconds_of_frame(renderer, scene, target);
        state.SetIterationTime(seconds);
        least = std::min(least, seconds);
    }
    // A picture of nothing would be quick.
    const Image middle = target.read(3);
    const Vec3f color = middle.rgb(width / 2, height / 2);
    if (!(color.length() > 0.01f)) state.SkipWithError("there is no teapot in the picture");
    state.counters["least_ms"] = 1000 * least;
    state.counters["over_constant_color"] = least / least_plain;
    state.counters["map_MB"] = static_cast<double>(renderer.map_bytes(scene)) / 1e6;
}

void add(const std::string& what, const Material& material, Method method) {
    benchmark::RegisterBenchmark(("frame/" + what).c_str(),
                                 [=](benchmark::State& state) { frame(state, material, method); })
        ->Arg(720)
        ->Arg(1080)
        ->Iterations(8)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

void add_all() {
    for (const Method method : all_methods()) add(std::string(name(method)), {}, method);
    Material of_all_terms;
    of_all_terms.mirror = 0.3, of_all_terms.glossy = 0.7, of_all_terms.diffuse = 0.5;
    of_all_terms.fresnel = Fresnel::dielectric(1.5);
    of_all_terms.coupling = Coupling::split_sum;
    add("cube, mirror and glossy and diffuse", of_all_terms, Method::cube);
}

}  // namespace
}  // namespace mirrorball::gl

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const mirrorball::gl::Context context;
    benchmark::AddCustomContext("driver", mirrorball::gl::driver().renderer);
    mirrorball::gl::add_all();
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
