// A level's statistics, texel by texel, so that a map need not be there as a whole.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <mirrorball/environment_map.h>

namespace mirrorball::detail {

/// Sums in the order in which texels are added.
class StatisticsSum {
  public:
    void add(const Vec3f& value, double solid_angle) {
        bool finite = true, negative = false;
        for (int c = 0; c < 3; ++c) {
            finite = finite && std::isfinite(value[c]);
            negative = negative || value[c] < 0;
            if (!std::isfinite(value[c])) continue;
            sum_.minimum[c] = std::min(sum_.minimum[c], value[c]);
            sum_.maximum[c] = std::max(sum_.maximum[c], value[c]);
        }
        ++sum_.texel_count;
        sum_.negative_count += negative ? 1 : 0;
        sum_.non_finite_count += finite ? 0 : 1;
        if (!finite) return;
        sum_.flux += Vec3d(value) * solid_angle;
        squares_ += Vec3d(value).dot(Vec3d(value)) * solid_angle;
    }

    [[nodiscard]] LevelStatistics result() const {
        LevelStatistics statistics = sum_;
        statistics.rms = std::sqrt(squares_ / (3 * 4 * kPi));
        return statistics;
    }

  private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    LevelStatistics sum_{Vec3d(0.0), Vec3f(kInfinity), Vec3f(-kInfinity), 0, 0, 0, 0};
    double squares_ = 0;
};

}  // namespace mirrorball::detail
