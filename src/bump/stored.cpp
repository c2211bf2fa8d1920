// Normal maps as pictures: 1/2 + n/2, green up or down.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/bump.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace {

void check_picture(const Image& picture) {
    if (picture.channels() < 3)
        throw Error(Errc::cannot_read,
                    fmt::format("a picture of {} channel{} is no normal map (3 were expected; one "
                                "alone may be heights)",
                                picture.channels(), picture.channels() == 1 ? "" : "s"));
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const Vec3f texel = picture.rgb(x, y);
            if (!std::isfinite(texel.x) || !std::isfinite(texel.y) || !std::isfinite(texel.z))
                throw Error(Errc::cannot_read,
                            fmt::format("the normal at column {}, row {} is ({}, {}, {}) (finite "
                                        "numbers were expected)",
                                        x, y, texel.x, texel.y, texel.z));
        }
}

double length(double x, double y, double z) {
    return std::hypot(x, y, z);
}

// Whether the picture holds n itself: some of it is clearly negative, or all of it is of unit
// length as it is and not as 1/2 + n/2.
bool holds_signed_values(const Image& picture) {
    constexpr float kClearlyNegative = -0.1f;  // not a resampling filter's overshoot
    constexpr double kUnitLength = 0.01;       // on average
    double as_is = 0, halved = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const Vec3f texel = picture.rgb(x, y);
            if (std::min({texel.x, texel.y, texel.z}) < kClearlyNegative) return true;
            const double from_middle =
                length(2.0 * texel.x - 1, 2.0 * texel.y - 1, 2.0 * texel.z - 1);
            as_is += std::abs(length(texel.x, texel.y, texel.z) - 1);
            halved += std::abs(from_middle - 1);
        }
    return as_is < halved && as_is < kUnitLength * static_cast<double>(picture.texel_count());
}

}  // namespace

Image stored_normals(const NormalMap& map, Green green) {
    const Image& normals = map.normals;
    Image picture(normals.width(), normals.height(), 3);
    const float up = green == Green::up ? 0.5f : -0.5f;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const Vec3f n = normals.rgb(x, y);
            picture.set_rgb(x, y, {0.5f + 0.5f * n.x, 0.5f + up * n.y, 0.5f + 0.5f * n.z});
        }
    return picture;
}

NormalMap parse_normals(const Image& picture, Green green, double step, NormalFaults* faults) {
    check_picture(picture);
    NormalFaults found;
    found.signed_values = holds_signed_values(picture);
    const auto component = [&](float value) -> double {
        if (found.signed_values) return value;
        const double n = 2 * double{value} - 1;
        return std::abs(n) <= 1.001 * step ? 0 : n;
    };
    NormalMap map{Image(picture.width(), picture.height(), 3)};
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const Vec3f texel = picture.rgb(x, y);
            Vec3d n(component(texel.x), component(texel.y), component(texel.z));
            if (green == Green::down && n.y != 0) n.y = -n.y;
            const double size = length(n.x, n.y, n.z);
            found.largest_length_error = std::max(found.largest_length_error, std::abs(size - 1));
            if (size < 1e-3) {
                ++found.without_count;
                n = {0, 0, 1};
            } else if (n.z <= 0) {
                // As steep as slopes(NormalMap) takes them.
                ++found.inward_count;
                const double lean = std::hypot(n.x, n.y);
                n = lean > 1e-3 * size ? Vec3d(n.x / lean, n.y / lean, 0.01) : Vec3d(0, 0, 1);
            }
            map.normals.set_rgb(x, y, Vec3f(n / length(n.x, n.y, n.z)));
        }
    if (faults != nullptr) *faults = found;
    return map;
}

}  // namespace mirrorball
