#include "harmonics/transforms.h"

#include <algorithm>
#include <cmath>

#include "core/flush_denormals.h"
#include "core/parallel.h"

namespace mirrorball::detail {
namespace {

// Values of a grid per value that its bands need. Eight taps then interpolate a lobe of GGX's
// spectrum to 2e-5 of its rms; a spectrum that is cut off while it is high needs more, and few
// bands can have it for nothing.
constexpr double kOversampling = 1.5, kMoreOversampling = 2.2, kMostOversampling = 3;
constexpr int kFewBands = 160;
// Eight taps along a line of a cube shall not bend far away from a ring.
constexpr int kLeastColumns = 128;
constexpr double kMostAtEdge = 1e-5;  // of the power, in the last quarter of the bands

double oversampling_for(std::span<const double> power) {
    double all = 0, edge = 0;
    for (std::size_t l = 0; l < power.size(); ++l) {
        const double here = (2 * static_cast<double>(l) + 1) * power[l];
        all += here;
        if (4 * l >= 3 * power.size()) edge += here;
    }
    if (edge > kMostAtEdge * all) return kMostOversampling;
    return power.size() < kFewBands ? kMoreOversampling : kOversampling;
}

RingTransform grid_transform(std::shared_ptr<const LegendreTable> table, int band_count,
                             double oversampling, std::shared_ptr<ScratchPool> scratch) {
    const double values = oversampling * band_count;
    const int whole = 2 * ring_lane_count();
    const int ring_count = (std::max(32, static_cast<int>(std::ceil(values))) + whole - 1) / whole;
    const int column_count =
        good_fourier_length(std::max(kLeastColumns, static_cast<int>(2 * values)));
    return RingTransform(std::move(table), band_count, ring_count * whole, column_count,
                         std::move(scratch));
}

// A panorama whose rows are rings of latitude, north first.
bool is_ring_grid(const MapShape& shape) {
    if (shape.projection != Projection::equirect) return false;
    if ((shape.axes.y - Vec3d(0, 1, 0)).length() > 1e-12) return false;
    // lengths with large prime factors take longer than spreading
    return largest_prime_factor(shape.size) <= 61;
}

// Of an upright panorama: texel column k is at u = (k + 1/2) / width.
Columns panorama_columns(const MapShape& shape) {
    const auto psi = [&](double u) {
        const Vec3d d = shape.axes.to_world(Equirect::direction(FacePoint<double>{0, u, 0.5}));
        return std::atan2(d.x, d.z);
    };
    const double first = psi(0.5 / shape.size);
    const double turn = std::remainder(psi(0.5 / shape.size + 0.1) - first, 2 * kPi);
    return {first, turn > 0 ? 1 : -1};
}

std::array<GroupValues, 3> make_planes(const RingTransform& rings) {
    return {rings.make_values(), rings.make_values(), rings.make_values()};
}

}  // namespace

AnalysisPlan::AnalysisPlan(const MapShape& shape, std::shared_ptr<const LegendreTable> table,
                           int band_count, std::span<const double> power,
                           std::shared_ptr<ScratchPool> scratch, std::optional<double> oversampling)
    : shape_(shape),
      band_count_(band_count) {
    if (is_ring_grid(shape)) {
        const int width = shape.size, height = shape.size / 2;
        rings_.emplace(std::move(table), band_count, height, width, std::move(scratch));
        columns_ = panorama_columns(shape);
        ring_weights_.assign(static_cast<std::size_t>(rings_->group_count()) * rings_->lane_count(),
                             0.0f);
        for (int j = 0; j < (height + 1) / 2; ++j) {
            const double cap = std::sin(kPi * (2 * j + 1) / (2.0 * height));
            ring_weights_[j] =
                static_cast<float>(2 * cap * std::sin(kPi / (2.0 * height)) * 2 * kPi / width);
        }
        return;
    }
    rings_.emplace(grid_transform(std::move(table), band_count,
                                  oversampling.value_or(oversampling_for(power)),
                                  std::move(scratch)));
    ring_weights_.assign(static_cast<std::size_t>(rings_->group_count()) * rings_->lane_count(),
                         1.0f);
    grid_ = make_texel_grid(shape, *rings_, GridTaps(*rings_, power), GridUse::analysis);
}

void AnalysisPlan::run(const std::vector<Image>& faces, Harmonics& harmonics,
                       const Progress& progress) const {
    RingSpectra spectra = rings_->make_spectra();
    TexelGrid::Buffer buffer;
    if (grid_) {
        buffer = grid_->make_buffer();
        grid_->spread_texels(faces, buffer);
    }
    parallel_for(
        rings_->group_count(),
        [&](std::int64_t i) {
            const FlushDenormals flush;
            const int group = static_cast<int>(i);
            std::array<GroupValues, 3> planes = make_planes(*rings_);
            GroupValues scratch = rings_->make_values();
            if (grid_)
                grid_->gather_group(group, buffer, planes);
            else
                rings_->load_rows(group, faces.front().values().data(), planes);
            rings_->to_spectra(group, planes, scratch, columns_, ring_weights_, spectra);
        },
        progress);
    rings_->analyse(spectra, harmonics);
}

SynthesisPlan::SynthesisPlan(const MapShape& shape, std::shared_ptr<const LegendreTable> table,
                             int band_count, std::span<const double> power,
                             std::shared_ptr<ScratchPool> scratch,
                             std::optional<double> oversampling)
    : shape_(shape),
      rings_(grid_transform(std::move(table), band_count,
                            oversampling.value_or(oversampling_for(power)), std::move(scratch))),
      taps_(rings_, power),
      grid_(make_texel_grid(shape, rings_, taps_, GridUse::synthesis)) {}

std::vector<double> SynthesisPlan::pair_colatitudes() const {
    std::vector<double> colatitudes(rings_.ring_count() / 2);
    for (std::size_t j = 0; j < colatitudes.size(); ++j)
        colatitudes[j] = (static_cast<double>(j) + 0.5) * kPi / rings_.ring_count();
    return colatitudes;
}

std::vector<double> SynthesisPlan::wave_errors() const {
    const double step = kPi / rings_.ring_count();
    std::vector<double> errors = taps_.along_columns.wave_errors(step, rings_.band_count());
    for (double& e : errors) e *= std::sqrt(2.0);  // along both directions
    return errors;
}

void SynthesisPlan::run(const Harmonics& harmonics, std::span<const float> zonal,
                        std::span<const float> ring_weights, const Vec3f& lowest,
                        const Vec3f& highest, std::vector<Image>& faces) const {
    RingSpectra spectra = rings_.make_spectra();
    rings_.synthesise(harmonics, zonal, spectra);
    TexelGrid::Buffer buffer = grid_->make_buffer();
    parallel_for(rings_.group_count(), [&](std::int64_t i) {
        const FlushDenormals flush;
        const int group = static_cast<int>(i);
        std::array<GroupValues, 3> planes = make_planes(rings_);
        GroupValues scratch = rings_.make_values();
        rings_.from_spectra(group, spectra, static_cast<int>(zonal.size()), ring_weights, planes,
                            scratch);
        grid_->scatter_group(group, planes, buffer);
    });
    grid_->make_texels(buffer, lowest, highest, faces);
}

}  // namespace mirrorball::detail
