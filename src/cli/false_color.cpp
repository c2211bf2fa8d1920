#include "false_color.h"

#include <algorithm>
#include <cmath>

namespace mirrorball::cli {

Vec3f false_color(double t) {
    const auto ramp = [t](double from, double to) {
        return std::clamp((t - from) / (to - from), 0.0, 1.0);
    };
    return {static_cast<float>(ramp(0.05, 0.6)), static_cast<float>(std::pow(ramp(0.4, 0.95), 1.5)),
            static_cast<float>(
                std::max(0.35 * ramp(0.0, 0.2) * (1 - ramp(0.35, 0.6)), ramp(0.8, 1.0)))};
}

}  // namespace mirrorball::cli
