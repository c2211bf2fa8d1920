#include <mirrorball/tone_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <mirrorball/error.h>

namespace mirrorball {
namespace {

constexpr double kGrey = 0.18, kKey = 0.25, kNearWhite = 0.8;

// x^1.25, many times faster than std::pow.
double with_contrast(double x) {
    return x * std::sqrt(std::sqrt(x));
}

constexpr std::array<std::string_view, 5> kNames = {"none", "reinhard", "aces", "agx", "film"};

// Above this every curve is 1 to the last bit of a float, and squares are still floats.
constexpr double kBrightest = 1e10;

// Without what is not a number, negative or infinite.
double exposed(float radiance, double exposure) {
    const double x = radiance * exposure;
    return x > 0 ? std::min(x, kBrightest) : 0;
}

double narkowicz(double x) {
    const double u = 0.6 * x;
    return std::min(1.0, u * (2.51 * u + 0.03) / (u * (2.43 * u + 0.59) + 0.14));
}

// AgX. With x the colours, M rows that add up to 1 (so greys stay grey) and C the curve,
//
//     y = (M^-1 C((log2(M x / 0.18) + 10) / 16.5))^2.2
//
// that is, from ten stops below a grey card to six and a half above. C is Sobotka's S, through (0,
// 0), the grey card's place and (1, 1):
//
//     C(u) = p_y + s h(slope (u - p_u) / s),  h(z) = z / (1 + |z|^power)^(1/power)
//
// with s such that it ends there, of its own for toe and shoulder. Next to his, p_y is chosen so
// that a grey card stays as it is, and M is rounded.
constexpr double kAgxStopsBelow = 10, kAgxStops = 16.5, kAgxSlope = 2;
constexpr double kAgxToePower = 3, kAgxShoulderPower = 3.25, kAgxGamma = 2.2;
constexpr double kAgxMix[3][3] = {
    {0.8425, 0.0784, 0.0791}, {0.0423, 0.8785, 0.0792}, {0.0424, 0.0784, 0.8792}};
constexpr double kAgxUnmix[3][3] = {{1.1968381468, -0.0979877515, -0.0988503952},
                                    {-0.0528494118, 1.1518560180, -0.0990066062},
                                    {-0.0530056228, -0.0979877515, 1.1509933743}};

Vec3d times(const double (&m)[3][3], const Vec3d& v) {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
            m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

// From the pivot, where it has the slope, to an end that is u and y away from it.
class HalfS {
  public:
    HalfS(double u, double y, double power)
        : power_(power),
          scale_(
              std::pow(std::pow(kAgxSlope * u, -power) * (std::pow(kAgxSlope * u / y, power) - 1),
                       -1 / power)) {}

    // How far y goes for a distance from the pivot.
    [[nodiscard]] double operator()(double distance) const {
        const double z = kAgxSlope * distance / scale_;
        return scale_ * z / std::pow(1 + std::pow(z, power_), 1 / power_);
    }

  private:
    double power_, scale_;
};

double agx_curve(double x) {
    static const double pivot_u = kAgxStopsBelow / kAgxStops;
    static const double pivot_y = std::pow(kGrey, 1 / kAgxGamma);
    static const HalfS toe(pivot_u, pivot_y, kAgxToePower);
    static const HalfS shoulder(1 - pivot_u, 1 - pivot_y, kAgxShoulderPower);
    const double stops = std::log2(std::max(x, 1e-10) / kGrey);
    const double u = std::clamp((stops + kAgxStopsBelow) / kAgxStops, 0.0, 1.0);
    if (u == 0) return 0;  // where rounding would leave a trace of light
    return u < pivot_u ? pivot_y - toe(pivot_u - u) : pivot_y + shoulder(u - pivot_u);
}

Vec3d agx(const Vec3d& x) {
    const Vec3d mixed = times(kAgxMix, x);
    const Vec3d y = times(kAgxUnmix, {agx_curve(mixed.x), agx_curve(mixed.y), agx_curve(mixed.z)});
    const auto light = [](double v) { return std::pow(std::clamp(v, 0.0, 1.0), kAgxGamma); };
    return {light(y.x), light(y.y), light(y.z)};
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

double film(double x) {
    static const double k = with_contrast(kGrey) * (1 - kGrey) / kGrey;
    const double y = with_contrast(x);
    return y / (y + k);
}

template <class Curve>
Vec3f per_channel(const Vec3d& x, Curve&& curve) {
    return Vec3f(Vec3d(curve(x.x), curve(x.y), curve(x.z)));
}

}  // namespace

std::string_view name(ToneMap tone_map) {
    return kNames[static_cast<std::size_t>(tone_map)];
}

ToneMap parse_tone_map(std::string_view name) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) {
        throw Error(Errc::usage, fmt::format("\"{}\" is not a tone map; there are: {}", name,
                                             fmt::join(kNames, ", ")));
    }
    return static_cast<ToneMap>(found - kNames.begin());
}

Vec3f tone_mapped(const Vec3f& radiance, double exposure, ToneMap tone_map) {
    const Vec3d x(exposed(radiance.x, exposure), exposed(radiance.y, exposure),
                  exposed(radiance.z, exposure));
    switch (tone_map) {
        case ToneMap::none:
            return per_channel(x, [](double v) { return std::min(v, 1.0); });
        case ToneMap::reinhard:
            return per_channel(x, [](double v) { return v / (1 + v); });
        case ToneMap::aces:
            return per_channel(x, narkowicz);
        case ToneMap::agx:
            return Vec3f(agx(x));
        case ToneMap::film:
            break;
    }
    return per_channel(x, film);
}

Image tone_mapped(const Image& image, double exposure, ToneMap tone_map) {
    Image result = image;
    const int channels = image.channels();
    const std::span<float> values = result.values();
    for (std::size_t i = 0; i < values.size(); i += channels) {
        float* const texel = &values[i];
        if (channels < 3) {
            texel[0] = tone_mapped(Vec3f(texel[0]), exposure, tone_map).x;
            continue;
        }
        const Vec3f y = tone_mapped(Vec3f(texel[0], texel[1], texel[2]), exposure, tone_map);
        texel[0] = y.x, texel[1] = y.y, texel[2] = y.z;
    }
    return result;
}

float tone_mapped(float radiance, double exposure) {
    return static_cast<float>(film(exposed(radiance, exposure)));
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
