// The public plans: the transforms with grids that do justice to all degrees.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/harmonics.h>
#include <mirrorball/zonal.h>

#include "harmonics/transforms.h"

namespace mirrorball {
namespace {

using namespace detail;

// Values of a grid per value that its bands need: eight taps interpolate a flat spectrum to 1e-5
// then. Few bands can have more for nothing, and need it: most of their degrees are the last ones.
constexpr double kOversampling = 3, kLeastValues = 128;

// The same for the spectrum of a lobe that the bands carry whole.
constexpr double kOversamplingForLobe = 1.5;

double at_least(double oversampling, int band_count) {
    return std::max(oversampling, kLeastValues / band_count);
}

// What a plan is made of, once it is known to make sense.
struct Parts {
    std::shared_ptr<const LegendreTable> table;
    std::vector<double> power;
    std::shared_ptr<ScratchPool> scratch = std::make_shared<ScratchPool>();

    Parts(const MapShape& shape, int band_count) {
        if (band_count < 1 || band_count > kLargestBandCount) {
            throw Error(Errc::usage,
                        fmt::format("{} bands of harmonics were asked for; there can be 1 to {}",
                                    band_count, kLargestBandCount));
        }
        (void)environment_map_bytes(shape.projection, shape.size);
        if (shape.size < 1 || (shape.projection == Projection::equirect && shape.size % 2 != 0)) {
            throw Error(Errc::usage, fmt::format("there is no {} of size {}",
                                                 name(shape.projection), shape.size));
        }
        table = std::make_shared<const LegendreTable>(band_count);
        power.assign(band_count, 1.0);
    }
};

void check_shape(const EnvironmentMap& map, const MapShape& shape) {
    const MapShape found = shape_of(map);
    if (found == shape) return;
    throw Error(
        Errc::usage,
        found.projection == shape.projection && found.size == shape.size
            ? fmt::format("the map's axes are {}, the plan's {}", to_string(found.axes),
                          to_string(shape.axes))
            : fmt::format("the map is {} of size {}, the plan is for {} of size {}",
                          name(found.projection), found.size, name(shape.projection), shape.size));
}

}  // namespace

class HarmonicAnalysis::Plan : public AnalysisPlan {
    using AnalysisPlan::AnalysisPlan;
};

HarmonicAnalysis::HarmonicAnalysis(const MapShape& shape, int band_count) {
    const Parts parts(shape, band_count);
    plan_ = std::make_shared<const Plan>(shape, parts.table, band_count, parts.power, parts.scratch,
                                         at_least(kOversampling, band_count));
}

Harmonics HarmonicAnalysis::operator()(const EnvironmentMap& map) const {
    Harmonics harmonics(band_count());
    (*this)(map, harmonics);
    return harmonics;
}

void HarmonicAnalysis::operator()(const EnvironmentMap& map, Harmonics& harmonics) const {
    check_shape(map, shape());
    if (harmonics.band_count() != band_count()) harmonics = Harmonics(band_count());
    plan_->run(map.levels[0].faces, harmonics);
    // Every texel is in the first coefficient, and none that is no number lets it be one.
    const Vec3f first = harmonics.coefficient(0, 0);
    if (!std::isfinite(first.x) || !std::isfinite(first.y) || !std::isfinite(first.z)) {
        throw Error(Errc::cannot_read,
                    "a texel of the map to analyse is NaN or infinite; all must be finite");
    }
}

const MapShape& HarmonicAnalysis::shape() const {
    return plan_->shape();
}

int HarmonicAnalysis::band_count() const {
    return plan_->band_count();
}

class HarmonicSynthesis::Plan : public SynthesisPlan {
    using SynthesisPlan::SynthesisPlan;
};

HarmonicSynthesis::HarmonicSynthesis(const MapShape& shape, int band_count) {
    const Parts parts(shape, band_count);
    plan_ = std::make_shared<const Plan>(shape, parts.table, band_count, parts.power, parts.scratch,
                                         at_least(kOversampling, band_count));
}

HarmonicSynthesis::HarmonicSynthesis(const MapShape& shape, int band_count, const Lobe& narrowest) {
    if (narrowest.is_delta() || mirrorball::band_count(narrowest, 1e-3) > band_count) {
        *this = HarmonicSynthesis(shape, band_count);
        return;
    }
    Parts parts(shape, band_count);
    parts.power = zonal_coefficients(narrowest, band_count);
    for (double& power : parts.power) power *= power;
    plan_ = std::make_shared<const Plan>(shape, parts.table, band_count, parts.power, parts.scratch,
                                         at_least(kOversamplingForLobe, band_count));
}

EnvironmentMap HarmonicSynthesis::operator()(const Harmonics& harmonics) const {
    EnvironmentMap map = make_environment_map(shape());
    (*this)(harmonics, std::vector<double>(band_count(), 1.0), map);
    return map;
}

void HarmonicSynthesis::operator()(const Harmonics& harmonics, std::span<const double> factors,
                                   EnvironmentMap& map, const TexelRange& range) const {
    check_shape(map, shape());
    const auto bands = static_cast<std::size_t>(std::min(band_count(), harmonics.band_count()));
    const std::span<const double> used = factors.first(std::min(factors.size(), bands));
    const std::vector<float> zonal(used.begin(), used.end());
    plan_->run(harmonics, zonal, {}, range.lowest, range.highest, map.levels[0].faces);
}

const MapShape& HarmonicSynthesis::shape() const {
    return plan_->shape();
}

int HarmonicSynthesis::band_count() const {
    return plan_->band_count();
}

Harmonics analyse(const EnvironmentMap& map, int band_count) {
    return HarmonicAnalysis(shape_of(map), band_count)(map);
}

EnvironmentMap synthesise(const Harmonics& harmonics, const MapShape& shape) {
    return HarmonicSynthesis(shape, std::max(1, harmonics.band_count()))(harmonics);
}

}  // namespace mirrorball
