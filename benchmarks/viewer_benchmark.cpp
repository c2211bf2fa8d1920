// Frames of the viewer at 1280 x 720, as a hand makes them: a chrome teapot that is turned, a
// slider of roughness that is dragged, an environment that is turned. Each frame is waited for with
// glFinish; what a window adds, its controls and the copy to the screen, is in
// `mirrorball view --script FILE --json`.
//
// `Time` is the median of the frames, `least_ms` the quickest, `processor_ms` what all threads
// took, which is the same on a machine that others use. Runs on whatever driver EGL finds.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <vector>

#include <benchmark/benchmark.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/viewer.h>

#include "gl/framebuffer_guard.h"
#include "viewer/smooth_picture.h"

namespace mirrorball {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kFrames = 60;

Scene scene_with(const Material& material) {
    Scene scene;
    scene.environment.source = "builtin:studio";
    scene.objects.push_back({"teapot", "teapot", {}, material, {}});
    return scene;
}

double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

using Step = std::function<void(Viewer&, int)>;

void frames(benchmark::State& state, const Material& material, const Step& step) {
    using Clock = std::chrono::steady_clock;
    Viewer viewer(scene_with(material), {}, {});
    viewer.frame_all(static_cast<double>(kWidth) / kHeight);
    const PictureTarget screen(kWidth, kHeight, GL_RGBA8, true);
    screen.bind();
    viewer.draw(kWidth, kHeight);  // what is kept from frame to frame is made
    for (auto _ : state) {
        std::vector<double> seconds;
        const double before = processor_seconds();
        for (int i = 0; i < kFrames; ++i) {
            glFinish();
            const Clock::time_point start = Clock::now();
            step(viewer, i);
            viewer.draw(kWidth, kHeight);
            glFinish();
            seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
        }
        state.counters["processor_ms"] = (processor_seconds() - before) / kFrames * 1000;
        std::sort(seconds.begin(), seconds.end());
        state.counters["least_ms"] = seconds.front() * 1000;
        state.counters["most_ms"] = seconds.back() * 1000;
        state.SetIterationTime(seconds[kFrames / 2]);
    }
}

void add(const std::string& name, const Material& material, const Step& step) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& state) { frames(state, material, step); })
        ->Iterations(1)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

// From `least` to `most` in a drag of kFrames, each a number that was not there before.
Step drag_of_lobes(Lobe::Kind kind, double least, double most) {
    return [=](Viewer& viewer, int i) {
        Scene scene = viewer.scene();
        const double share = (i + 0.5) / kFrames;
        scene.objects[0].material.lobe = {kind, least + (most - least) * share};
        viewer.set_scene(scene);
    };
}

void add_all() {
    const Step orbit = [](Viewer& viewer, int) { viewer.orbit(7, 0.3, kHeight); };
    add("orbit/chrome", preset_material("chrome"), orbit);
    add("orbit/glossy", preset_material("gold"), orbit);
    add("turn_environment", preset_material("chrome"),
        [](Viewer& viewer, int) { viewer.turn_environment(7, kHeight); });
    Material glossy = preset_material("chrome");
    glossy.mirror = 0, glossy.glossy = 1;
    add("new_lobe/ggx 0.3 to 1", glossy, drag_of_lobes(Lobe::Kind::ggx, 0.3, 1));
    add("new_lobe/ggx 0.1 to 0.3", glossy, drag_of_lobes(Lobe::Kind::ggx, 0.1, 0.3));
    add("new_lobe/ggx 0 to 0.1", glossy, drag_of_lobes(Lobe::Kind::ggx, 0, 0.1));
    add("new_lobe/phong 1 to 100", glossy, drag_of_lobes(Lobe::Kind::phong, 1, 100));
    add("new_lobe/phong 100 to 2000", glossy, drag_of_lobes(Lobe::Kind::phong, 100, 2000));
}

}  // namespace
}  // namespace mirrorball

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const mirrorball::gl::Context context;
    benchmark::AddCustomContext("driver", mirrorball::gl::driver().renderer);
    mirrorball::add_all();
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
