#include "prefilter/source_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "core/parallel.h"
#include "core/vectorized.h"

namespace mirrorball::detail {
namespace {

// f(face, y) for each row of level 0, in parallel.
template <class F>
void for_each_row(const EnvironmentMap& map, const F& f) {
    const int height = map.height();
    parallel_for(static_cast<std::int64_t>(map.levels[0].faces.size()) * height,
                 [&](std::int64_t row) {
                     f(row, map.levels[0].faces[row / height], static_cast<int>(row % height));
                 });
}

std::size_t row_count(const EnvironmentMap& map) {
    return map.levels[0].faces.size() * static_cast<std::size_t>(map.height());
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Per channel of a row: least and greatest.
struct RowRange {
    float lowest[3] = {kInfinity, kInfinity, kInfinity};
    float highest[3] = {-kInfinity, -kInfinity, -kInfinity};
    bool finite = true;
};

// A row all of whose texels are used: values are taken three vectors at a time.
RowRange range_of_whole_row(std::span<const float> row) {
    constexpr std::size_t kStep = 24;
    float low[kStep], high[kStep], sum[kStep];
    std::fill_n(low, kStep, kInfinity);
    std::fill_n(high, kStep, -kInfinity);
    std::fill_n(sum, kStep, 0.0f);
    std::size_t x = 0;
    vectorized([&]() MIRRORBALL_INLINE_BODY {
        for (; x + kStep <= row.size(); x += kStep) {
            for (std::size_t i = 0; i < kStep; ++i) {
                const float v = row[x + i];
                low[i] = v < low[i] ? v : low[i];
                high[i] = v > high[i] ? v : high[i];
                sum[i] += v * 0.0f;  // NaN if any is not finite
            }
        }
    });
    RowRange range;
    float all = 0;
    for (std::size_t i = 0; i < kStep; ++i) {
        range.lowest[i % 3] = std::min(range.lowest[i % 3], low[i]);
        range.highest[i % 3] = std::max(range.highest[i % 3], high[i]);
        all += sum[i];
    }
    for (; x < row.size(); ++x) {
        range.lowest[x % 3] = std::min(range.lowest[x % 3], row[x]);
        range.highest[x % 3] = std::max(range.highest[x % 3], row[x]);
        all += row[x] * 0.0f;
    }
    range.finite = !std::isnan(all);
    return range;
}

RowRange range_of_row(std::span<const float> row, const double* solid_angles) {
    RowRange range;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (solid_angles[i / 3] == 0) continue;
        range.lowest[i % 3] = std::min(range.lowest[i % 3], row[i]);
        range.highest[i % 3] = std::max(range.highest[i % 3], row[i]);
        range.finite = range.finite && std::isfinite(row[i]);
    }
    return range;
}

bool any_above(const float* values, std::size_t count, float threshold) {
    int any = 0;
    for (std::size_t i = 0; i < count; ++i) any |= values[i] > threshold;
    return any != 0;
}

// Texels with a channel above `limit`, as far as they are above it, or all of them, whole.
std::vector<Light> lights_of(const EnvironmentMap& map, const std::vector<double>& solid_angles,
                             const SourceRange* range, std::optional<float> limit) {
    constexpr std::size_t kStretch = 16;
    const auto width = static_cast<std::size_t>(map.width());
    std::vector<std::vector<Light>> rows(row_count(map));
    visit(map.projection, [&](auto p) {
        using P = decltype(p);
        const auto light = [&](std::int64_t i, int y, std::size_t x, const float* rgb) {
            const double solid_angle = solid_angles[static_cast<std::size_t>(y) * width + x];
            const FacePoint<double> centre{static_cast<int>(i / map.height()),
                                           (static_cast<double>(x) + 0.5) / map.width(),
                                           (y + 0.5) / map.height()};
            Vec3f power;
            for (int c = 0; c < 3; ++c) {
                const float above = limit ? std::max(rgb[c] - *limit, 0.0f) : rgb[c];
                power[c] = above * static_cast<float>(solid_angle);
            }
            return Light{Vec3f(map.axes.to_world(P::direction(centre))), power,
                         static_cast<float>(solid_angle)};
        };
        for_each_row(map, [&](std::int64_t i, const Image& image, int y) {
            if (limit && !(range->rows[i] > *limit)) return;
            const float* const row = image.row(y).data();
            const double* const used = solid_angles.data() + static_cast<std::size_t>(y) * width;
            for (std::size_t x0 = 0; x0 < width; x0 += kStretch) {
                const std::size_t end = std::min(x0 + kStretch, width);
                if (limit && !any_above(row + 3 * x0, 3 * (end - x0), *limit)) continue;
                for (std::size_t x = x0; x < end; ++x) {
                    if (used[x] > 0 && (!limit || any_above(row + 3 * x, 3, *limit)))
                        rows[i].push_back(light(i, y, x, row + 3 * x));
                }
            }
        });
    });
    std::vector<Light> lights;
    for (const auto& row : rows) lights.insert(lights.end(), row.begin(), row.end());
    return lights;
}

}  // namespace

SourceRange range_of(const EnvironmentMap& map, const std::vector<double>& solid_angles) {
    std::vector<RowRange> rows(row_count(map));
    const auto width = static_cast<std::size_t>(map.width());
    const bool fills = visit(map.projection, [](auto p) { return decltype(p)::fills_square; });
    for_each_row(map, [&](std::int64_t i, const Image& image, int y) {
        const double* const row = solid_angles.data() + width * static_cast<std::size_t>(y);
        rows[i] = fills ? range_of_whole_row(image.row(y)) : range_of_row(image.row(y), row);
    });
    SourceRange range{
        Vec3f(kInfinity, kInfinity, kInfinity), Vec3f(-kInfinity, -kInfinity, -kInfinity), {}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!rows[i].finite) {
            const std::size_t height = map.height();
            throw Error(Errc::usage,
                        fmt::format("prefiltering: row {} of face {} holds a value that is not "
                                    "finite; expected numbers",
                                    i % height, i / height));
        }
        for (int c = 0; c < 3; ++c) {
            range.lowest[c] = std::min(range.lowest[c], rows[i].lowest[c]);
            range.highest[c] = std::max(range.highest[c], rows[i].highest[c]);
        }
        range.rows.push_back(
            std::max({rows[i].highest[0], rows[i].highest[1], rows[i].highest[2]}));
    }
    return range;
}

std::vector<Light> all_lights(const EnvironmentMap& map, const std::vector<double>& solid_angles) {
    return lights_of(map, solid_angles, nullptr, std::nullopt);
}

LightLevels::LightLevels(const EnvironmentMap& map, const std::vector<double>& solid_angles,
                         const SourceRange& range, float mean)
    : map_(map),
      solid_angles_(solid_angles),
      range_(range),
      mean_(mean),
      brightest_(std::max({range.highest.x, range.highest.y, range.highest.z})) {}

const std::vector<Light>& LightLevels::lights(std::size_t level) {
    std::optional<std::vector<Light>>& found = levels_[level].lights;
    if (!found && level <= kUsual) {
        found = lights_of(map_, solid_angles_, &range_, threshold(level));
    } else if (!found) {
        // of those that are above the usual threshold already
        const float rise = threshold(level) - threshold(kUsual);
        found.emplace();
        for (Light light : lights(kUsual)) {
            for (int c = 0; c < 3; ++c)
                light.power[c] = std::max(light.power[c] - rise * light.solid_angle, 0.0f);
            if (light.power != Vec3f(0.0f)) found->push_back(light);
        }
    }
    return *found;
}

const NearField& LightLevels::field(std::size_t level) {
    std::optional<NearField>& field = levels_[level].field;
    if (!field) field.emplace(lights(level));
    return *field;
}

double LightLevels::deviation() {
    if (!deviation_) deviation_ = deviation_from_usual(kInfinity);
    return *deviation_;
}

double LightLevels::rest(std::size_t level) {
    std::optional<double>& rest = levels_[level].rest;
    if (!rest) {
        rest = level >= kUsual ? deviation_from_usual(threshold(level))
                               : deviation_of(moments_below(threshold(level))) / mean_;
    }
    return *rest;
}

double LightLevels::deviation_from_usual(float limit) {
    const float usual = threshold(kUsual);
    if (!usual_moments_) usual_moments_ = moments_below(usual);
    Moments moments = *usual_moments_;
    for (const Light& light : lights(kUsual)) {
        for (int c = 0; c < 3; ++c) {
            const double above = std::min(light.power[c] / light.solid_angle, limit - usual);
            moments.first += light.solid_angle * above;
            moments.second += light.solid_angle * above * (above + 2.0 * usual);
        }
    }
    return deviation_of(moments) / mean_;
}

double LightLevels::deviation_of(const Moments& moments) {
    const double mean = moments.first / (3 * 4 * kPi);
    return std::sqrt(std::max(0.0, moments.second / (3 * 4 * kPi) - mean * mean));
}

LightLevels::Moments LightLevels::moments_below(float threshold) const {
    const auto width = static_cast<std::size_t>(map_.width());
    std::vector<Moments> rows(row_count(map_));
    for_each_row(map_, [&](std::int64_t i, const Image& image, int y) {
        const double* const row = solid_angles_.data() + width * static_cast<std::size_t>(y);
        const std::span<const float> values = image.row(y);
        // few terms in single precision at a time, each times its texel's share of a full row
        constexpr std::size_t kStretch = 64;
        for (std::size_t x = 0; x < width; x += kStretch) {
            const std::size_t end = std::min(x + kStretch, width);
            float first = 0, second = 0;
            vectorized([&]() MIRRORBALL_INLINE_BODY {
                float sums[6] = {};
                for (std::size_t k = x; k < end; ++k) {
                    const auto weight = static_cast<float>(row[k]);
                    for (std::size_t c = 0; c < 3; ++c) {
                        const float v = values[3 * k + c];
                        const float below = v < threshold ? v : threshold;
                        sums[c] += weight * below;
                        sums[3 + c] += weight * below * below;
                    }
                }
                first = sums[0] + sums[1] + sums[2], second = sums[3] + sums[4] + sums[5];
            });
            rows[i].first += first, rows[i].second += second;
        }
    });
    Moments all;
    for (const Moments& row : rows) all.first += row.first, all.second += row.second;
    return all;
}

}  // namespace mirrorball::detail
