#include "method_comparison.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <mirrorball/direct.h>
#include <mirrorball/error.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/tone_map.h>

#include "io/codec.h"

namespace mirrorball::cli {
namespace {

constexpr int kTimedFrames = 9;

// The environment itself for mirrors; for other terms maps of twice the usual fineness.
ReflectionMaps true_maps(const LoadedScene& loaded) {
    EnvironmentMap environment = loaded.assets->environment;
    environment.axes = turned(environment.axes, loaded.scene.environment);
    ReflectionMaps maps = make_reflection_maps(
        environment, lobes_of(loaded.scene), Projection::cube,
        2 * mirror_map_size(environment, Projection::cube), default_axes(Projection::cube));
    maps.mirror = std::move(environment);
    return maps;
}

void add(Image& sum, const Image& image) {
    std::transform(sum.values().begin(), sum.values().end(), image.values().begin(),
                   sum.values().begin(), std::plus<>());
}

// What classic bump mapping stands for.
Scene with_turned_normals(Scene scene) {
    for (SceneObject& object : scene.objects) object.material.bump.form = BumpForm::normals;
    return scene;
}

struct Truth {
    Image displayed;
    Image seen;  ///< the share of each pixel's samples that meet an object
};

// Where a method may differ at all: where there is an object, and no other sample of the pixel
// misses it, so that silhouettes do not count.
Truth evaluate(const LoadedScene& loaded, gl::Renderer& renderer, int width, int height,
               int sample_count) {
    const Scene scene = with_turned_normals(loaded.scene);
    const ReflectionMaps maps = true_maps(loaded);
    const double exposure = exposure_of(loaded.scene, usual_exposure(loaded.assets->environment));
    Truth truth{Image(width, height, 3), Image(width, height, 1)};
    for (int i = 0; i < sample_count; ++i) {
        const SurfaceBuffer surfaces =
            renderer.surfaces(loaded.scene, width, height, gl::sample_shift(i, sample_count));
        const Image radiance = shade(scene, *loaded.assets, maps, surfaces);
        add(truth.displayed, tone_mapped(radiance, exposure, loaded.scene.tone_map));
        for (std::size_t k = 0; k < surfaces.object.values().size(); ++k)
            truth.seen.values()[k] += surfaces.object.values()[k] >= 0 ? 1.0f : 0.0f;
    }
    for (float& value : truth.displayed.values()) value /= static_cast<float>(sample_count);
    for (float& value : truth.seen.values()) value /= static_cast<float>(sample_count);
    return truth;
}

double step(float displayed) {
    return 255.0 * detail::linear_to_srgb(std::clamp(displayed, 0.0f, 1.0f));
}

void measure(MethodResult& result, const Truth& truth) {
    const int width = truth.displayed.width(), height = truth.displayed.height();
    result.error = Image(width, height, 1);
    std::vector<double> errors;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (*truth.seen.at(x, y) < 1) continue;
            double sum = 0;
            for (int c = 0; c < 3; ++c)
                sum +=
                    std::abs(step(result.picture.at(x, y)[c]) - step(truth.displayed.at(x, y)[c]));
            errors.push_back(sum / 3);
            *result.error.at(x, y) = static_cast<float>(sum / 3);
        }
    }
    if (errors.empty()) return;
    result.mean_error =
        std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
    const auto at_99 = errors.begin() + std::ssize(errors) * 99 / 100;
    std::nth_element(errors.begin(), at_99, errors.end());
    result.percentile_99 = *at_99;
    result.largest_error = *std::max_element(at_99, errors.end());
}

// The objects alone in black: what drawing them costs before anything is reflected.
Scene in_constant_color(Scene scene) {
    for (SceneObject& object : scene.objects) {
        object.material = {};
        object.material.mirror = 0;
        object.dynamic.reset();
    }
    scene.method = Method::cube;
    return scene;
}

double median_frame(gl::Renderer& renderer, const Scene& scene, int width, int height) {
    std::vector<double> seconds = renderer.time_frames(scene, width, height, kTimedFrames);
    std::nth_element(seconds.begin(), seconds.begin() + kTimedFrames / 2, seconds.end());
    return seconds[kTimedFrames / 2];
}

}  // namespace

MethodComparison compare_methods(const LoadedScene& loaded, int width, int height, int sample_count,
                                 std::span<const Method> methods, const Progress& progress) {
    gl::Renderer renderer(loaded.assets);
    const Truth truth = evaluate(loaded, renderer, width, height, sample_count);
    MethodComparison comparison;
    comparison.truth = truth.displayed;
    comparison.pixel_count = std::count_if(truth.seen.values().begin(), truth.seen.values().end(),
                                           [](float share) { return share >= 1; });
    comparison.constant_seconds =
        median_frame(renderer, in_constant_color(loaded.scene), width, height);
    for (const Method method : methods) {
        Scene scene = loaded.scene;
        scene.method = method;
        MethodResult& result = comparison.results.emplace_back();
        result.method = method;
        result.picture = renderer.picture(
            scene, {.width = width, .height = height, .sample_count = sample_count});
        result.map_bytes = renderer.map_bytes(scene);
        result.frame_seconds = median_frame(renderer, scene, width, height);
        measure(result, truth);
        if (progress && !progress(static_cast<double>(comparison.results.size()) /
                                  static_cast<double>(methods.size())))
            throw Error(Errc::cancelled, "comparing was cancelled");
    }
    return comparison;
}

}  // namespace mirrorball::cli
