#include <mirrorball/nine_harmonics.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "core/parallel.h"

namespace mirrorball {
namespace {

void add(NineHarmonics& sum, const NineHarmonics& more) {
    for (int i = 0; i < kNineHarmonics; ++i) sum.coefficients[i] += more.coefficients[i];
}

// Of the basis functions' polynomials.
const std::array<double, kNineHarmonics>& constants() {
    static const std::array<double, kNineHarmonics> k = [] {
        const double k1 = std::sqrt(3 / (4 * kPi)), k2 = std::sqrt(15 / (4 * kPi));
        return std::array<double, kNineHarmonics>{std::sqrt(1 / (4 * kPi)),  k1, k1,    k1, k2, k2,
                                                  std::sqrt(5 / (16 * kPi)), k2, k2 / 2};
    }();
    return k;
}

struct NamedScale {
    HarmonicScale scale;
    std::string_view name;
};
constexpr NamedScale kScales[] = {
    {HarmonicScale::radiance, "radiance"}, {HarmonicScale::irradiance, "irradiance"},
    {HarmonicScale::outgoing, "outgoing"}, {HarmonicScale::polynomial, "polynomial"},
    {HarmonicScale::filament, "filament"}, {HarmonicScale::three_js, "three.js"},
    {HarmonicScale::unity, "unity"}};

// What a white matte surface shows, for polynomials without constants.
NineHarmonics as_polynomial(const NineHarmonics& radiance) {
    NineHarmonics result = convolved_with_cosine(radiance);
    for (int i = 0; i < kNineHarmonics; ++i) result.coefficients[i] *= constants()[i] / kPi;
    return result;
}

template <class P>
NineHarmonics analyse_row(P, const EnvironmentMap& map, const Image& image, int face, int y,
                          const std::vector<double>& solid_angles) {
    NineHarmonics sum;
    const int width = image.width();
    for (int x = 0; x < width; ++x) {
        const double solid_angle = solid_angles[static_cast<std::size_t>(y) * width + x];
        if (solid_angle == 0) continue;
        const FacePoint<double> centre{face, (x + 0.5) / width, (y + 0.5) / image.height()};
        const auto basis = nine_harmonic_basis(map.axes.to_world(P::direction(centre)));
        const Vec3d power = Vec3d(image.rgb(x, y)) * solid_angle;
        for (int i = 0; i < kNineHarmonics; ++i) sum.coefficients[i] += power * basis[i];
    }
    return sum;
}

}  // namespace

std::array<double, kNineHarmonics> nine_harmonic_basis(const Vec3d& d) {
    const auto& k = constants();
    return {k[0],
            k[1] * d.y,
            k[2] * d.z,
            k[3] * d.x,
            k[4] * d.x * d.y,
            k[5] * d.y * d.z,
            k[6] * (3 * d.z * d.z - 1),
            k[7] * d.x * d.z,
            k[8] * (d.x * d.x - d.y * d.y)};
}

// Each row has its own sum, and the rows are added in order: the same bits for any thread count.
NineHarmonics analyse_nine(const EnvironmentMap& map, int level) {
    const Level& source = map.levels[level];
    const int height = source.height();
    const auto solid_angles = solid_angle_table(map.projection, source.width(), height);
    std::vector<NineHarmonics> rows(source.faces.size() * static_cast<std::size_t>(height));
    visit(map.projection, [&](auto projection) {
        detail::parallel_for(static_cast<std::int64_t>(rows.size()), [&](std::int64_t i) {
            const int face = static_cast<int>(i / height), y = static_cast<int>(i % height);
            rows[i] = analyse_row(projection, map, source.faces[face], face, y, solid_angles);
        });
    });
    NineHarmonics sum;
    for (const NineHarmonics& row : rows) add(sum, row);
    return sum;
}

NineHarmonics convolved_with_cosine(const NineHarmonics& radiance) {
    NineHarmonics irradiance = radiance;
    for (int i = 0; i < kNineHarmonics; ++i) {
        irradiance.coefficients[i] *= i == 0 ? kPi : i < 4 ? 2 * kPi / 3 : kPi / 4;
    }
    return irradiance;
}

Vec3d evaluate(const NineHarmonics& harmonics, const Vec3d& direction) {
    const auto basis = nine_harmonic_basis(direction);
    Vec3d sum(0, 0, 0);
    for (int i = 0; i < kNineHarmonics; ++i) sum += harmonics.coefficients[i] * basis[i];
    return sum;
}

NineHarmonics nine_harmonics(const Harmonics& harmonics) {
    const auto at = [&](int l, int m) {
        return l < harmonics.band_count() ? Vec3d(harmonics.coefficient(l, m)) : Vec3d(0, 0, 0);
    };
    NineHarmonics nine;
    auto& to = nine.coefficients;
    to[0] = at(0, 0);
    to[1] = at(1, 0);   // y
    to[2] = at(1, 1);   // z
    to[3] = at(1, -1);  // x
    to[4] = at(2, -1);  // xy
    to[5] = at(2, 1);   // yz
    to[7] = at(2, -2);  // xz
    // 3y^2-1 and sqrt3 (z^2-x^2) are 3z^2-1 and sqrt3 (x^2-y^2), turned by 120 degrees
    const double half = 0.5, root = std::sqrt(0.75);
    to[6] = at(2, 2) * root - at(2, 0) * half;
    to[8] = -at(2, 0) * root - at(2, 2) * half;
    return nine;
}

std::string_view name(HarmonicScale scale) {
    return kScales[static_cast<std::size_t>(scale)].name;
}

std::vector<HarmonicScale> harmonic_scales() {
    std::vector<HarmonicScale> scales;
    for (const NamedScale& named : kScales) scales.push_back(named.scale);
    return scales;
}

HarmonicScale parse_harmonic_scale(std::string_view text) {
    std::string names;
    for (const NamedScale& named : kScales) {
        if (named.name == text) return named.scale;
        names += names.empty() ? "" : " ";
        names += named.name;
    }
    throw Error(Errc::usage,
                fmt::format("\"{}\" is not a scale of harmonics; there are: {}", text, names));
}

NineHarmonics scaled(const NineHarmonics& radiance, HarmonicScale scale) {
    switch (scale) {
        case HarmonicScale::radiance:
        case HarmonicScale::three_js:
            return radiance;
        case HarmonicScale::irradiance:
            return convolved_with_cosine(radiance);
        case HarmonicScale::outgoing: {
            NineHarmonics result = convolved_with_cosine(radiance);
            for (Vec3d& coefficient : result.coefficients) coefficient /= kPi;
            return result;
        }
        case HarmonicScale::polynomial:
        case HarmonicScale::filament:
            return as_polynomial(radiance);
        case HarmonicScale::unity: {
            NineHarmonics result = as_polynomial(radiance);
            for (const int odd_in_z : {2, 5, 7}) result.coefficients[odd_in_z] *= -1;
            return result;
        }
    }
    return radiance;
}

}  // namespace mirrorball
