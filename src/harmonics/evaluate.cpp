#include <cmath>

#include <mirrorball/harmonics.h>

#include "harmonics/legendre_column.h"

namespace mirrorball {

using namespace detail;

Vec3d evaluate(const Harmonics& harmonics, const Vec3d& direction) {
    const double sine = std::hypot(direction.x, direction.z), cosine = direction.y;
    const double psi = std::atan2(direction.x, direction.z);
    FirstLegendre first;
    Vec3d sum(0, 0, 0);
    for (int m = 0; m < harmonics.band_count(); ++m, first.advance()) {
        if (m > 0 && sine == 0) break;  // at a pole there are no orders but 0
        double cosines[3] = {}, sines[3] = {};
        LegendreColumn p(m, first.log(), cosine, sine);
        const std::span<const float> order = harmonics.order(m);
        for (std::size_t i = 0; i < order.size(); i += 6, p.advance()) {
            const double value = p.value();
            for (std::size_t c = 0; c < 3; ++c) {
                cosines[c] += value * order[i + c];
                sines[c] += value * order[i + 3 + c];
            }
        }
        const double c = std::cos(m * psi), s = std::sin(m * psi);
        sum +=
            Vec3d(cosines[0], cosines[1], cosines[2]) * c + Vec3d(sines[0], sines[1], sines[2]) * s;
    }
    return sum;
}

}  // namespace mirrorball
