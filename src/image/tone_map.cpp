#include <mirrorball/tone_map.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace mirrorball {
namespace {

constexpr double kGrey = 0.18, kKey = 0.25, kNearWhite = 0.8;

// x^1.25, many times faster than std::pow.
double with_contrast(double x) {
    return x * std::sqrt(std::sqrt(x));
}

// Solid angle by luminance, in tenths of a stop from 2^-40 to 2^40.
class Histogram {
  public:
    void add(double luminance, double solid_angle) {
        const double place = 10 * (std::log2(std::max(luminance, 1e-30)) + 40);
        bins_[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0))] += solid_angle;
        total_ += solid_angle;
    }

    [[nodiscard]] double percentile(double share) const {
        double sum = 0;
        for (std::size_t i = 0; i < kBins; ++i) {
            sum += bins_[i];
            if (sum >= share * total_) return luminance(i);
        }
        return luminance(kBins - 1);
    }

    // Light below a thousandth of the brightest percent counts as that: black has no logarithm, and
    // how black it is must not decide about the picture.
    [[nodiscard]] double logarithmic_mean() const {
        const double least = percentile(0.99) * 1e-3;
        double sum = 0;
        for (std::size_t i = 0; i < kBins; ++i) {
            sum += bins_[i] * std::log(std::max(luminance(i), least));
        }
        return std::exp(sum / total_);
    }

    [[nodiscard]] double mean() const {
        double sum = 0;
        for (std::size_t i = 0; i < kBins; ++i) sum += bins_[i] * luminance(i);
        return sum / total_;
    }

  private:
    static constexpr std::size_t kBins = 800;

    static double luminance(std::size_t bin) {
        return std::exp2((static_cast<double>(bin) + 0.5) / 10 - 40);
    }

    std::array<double, kBins> bins_{};
    double total_ = 0;
};

// Rec. 709 primaries.
double luminance(const Vec3f& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

Histogram histogram(const EnvironmentMap& map, int level) {
    const Level& source = map.levels[level];
    const int width = source.width(), height = source.height();
    const auto solid_angles = solid_angle_table(map.projection, width, height);
    Histogram result;
    for (const Image& face : source.faces) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double solid_angle = solid_angles[static_cast<std::size_t>(y) * width + x];
                if (solid_angle > 0) result.add(luminance(face.rgb(x, y)), solid_angle);
            }
        }
    }
    return result;
}

}  // namespace

float tone_mapped(float radiance, double exposure) {
    static const double k = with_contrast(kGrey) * (1 - kGrey) / kGrey;
    const double x = with_contrast(std::max(0.0, radiance * exposure));
    return std::isinf(x) ? 1.0f : static_cast<float>(x / (x + k));
}

Image tone_mapped(const Image& image, double exposure) {
    Image result = image;
    for (float& value : result.values()) value = tone_mapped(value, exposure);
    return result;
}

EnvironmentMap tone_mapped(const EnvironmentMap& map, double exposure) {
    EnvironmentMap result{map.projection, map.axes, {}};
    for (const Level& level : map.levels) {
        Level& mapped = result.levels.emplace_back();
        for (const Image& face : level.faces) mapped.faces.push_back(tone_mapped(face, exposure));
    }
    return result;
}

double usual_exposure(const EnvironmentMap& map, int level) {
    const Histogram light = histogram(map, level);
    const double typical = std::sqrt(light.logarithmic_mean() * light.mean());
    return std::max(kKey / typical, kNearWhite / light.percentile(0.99));
}

}  // namespace mirrorball
