// The 1-D Fresnel map, and how far straight lines between its samples are from the curve.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/fresnel.h>

#include "prefilter/gauss_legendre.h"

namespace mirrorball {
namespace {

constexpr int kMostSamples = 65536;

}  // namespace

FresnelMap::FresnelMap(const Fresnel& fresnel, int sample_count) : exact_(fresnel) {
    if (sample_count < 2 || sample_count > kMostSamples)
        throw Error(Errc::usage, fmt::format("a Fresnel map of {} samples; expected 2 to {}",
                                             sample_count, kMostSamples));
    samples_.reserve(static_cast<std::size_t>(sample_count));
    for (int i = 0; i < sample_count; ++i)
        samples_.emplace_back(fresnel(static_cast<double>(i) / (sample_count - 1)));
}

Vec3d FresnelMap::operator()(double cos_theta) const {
    const int last = static_cast<int>(samples_.size()) - 1;
    const double position = std::clamp(cos_theta, 0.0, 1.0) * last;
    const int left = std::min(static_cast<int>(position), last - 1);
    const double share = position - left;
    return Vec3d(samples_[left]) * (1 - share) + Vec3d(samples_[left + 1]) * share;
}

Image FresnelMap::image() const {
    Image image(static_cast<int>(samples_.size()), 1, 3);
    for (int i = 0; i < image.width(); ++i) image.set_rgb(i, 0, samples_[i]);
    return image;
}

FresnelMap::InterpolationError FresnelMap::interpolation_error() const {
    const int interval_count = static_cast<int>(samples_.size()) - 1;
    InterpolationError error;
    double square_sum = 0;
    for (int i = 0; i < interval_count; ++i) {
        for (const auto& [x, weight] : detail::gauss_legendre(8)) {
            const double cosine = (i + (1 + x) / 2) / interval_count;
            const Vec3d difference = (*this)(cosine)-exact_(cosine);
            square_sum += weight / 2 / interval_count * difference.dot(difference) / 3;
            for (int c = 0; c < 3; ++c) {
                if (std::abs(difference[c]) <= error.largest) continue;
                error.largest = std::abs(difference[c]);
                error.at_cosine = cosine;
            }
        }
    }
    error.rms = std::sqrt(square_sum);
    return error;
}

}  // namespace mirrorball
