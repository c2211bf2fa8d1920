// What the benchmarks share: a source to work on, and the check that work on it kept its light.
#pragma once

#include <cmath>

#include <benchmark/benchmark.h>
#include <mirrorball/builtin.h>
#include <mirrorball/environment_map.h>

namespace mirrorball {

/// The built-in sunset as a panorama of this width.
inline EnvironmentMap panorama(int width) {
    return make_builtin("sunset", Projection::equirect, width, default_axes(Projection::equirect));
}

inline std::int64_t texel_count(const EnvironmentMap& map) {
    return map.levels[0].faces[0].texel_count() *
           static_cast<std::int64_t>(map.levels[0].faces.size());
}

/// Fails the benchmark where the flux of `result` is not that of `source`, times `factor`.
inline void expect_flux(benchmark::State& state, const EnvironmentMap& result,
                        const EnvironmentMap& source, double tolerance, double factor = 1) {
    const Vec3d expected = flux(source) * factor;
    if (!((flux(result) - expected).length() <= tolerance * expected.length()))
        state.SkipWithError("the flux changed: the result is wrong, so its time means nothing");
}

}  // namespace mirrorball
