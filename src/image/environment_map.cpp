#include <mirrorball/environment_map.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "image/for_each_texel.h"
#include "image/map_size.h"
#include "image/statistics_sum.h"

namespace mirrorball {
namespace {

double step(const Vec3f& a, const Vec3f& b) {
    return std::abs(double{a.x} - b.x) + std::abs(double{a.y} - b.y) + std::abs(double{a.z} - b.z);
}

// Sums of steps per radian across seams and just inside them.
struct SeamSteps {
    double across = 0, inside = 0;
};

template <class P>
class SeamWalk {
  public:
    explicit SeamWalk(const Level& level) : level_(level), w_(level.width()), h_(level.height()) {}

    // From every used texel towards each side; where that leaves the used part, the step across is
    // weighed against the step to the opposite neighbour.
    SeamSteps walk() const {
        SeamSteps sum;
        for (int face = 0; face < P::face_count; ++face)
            for (int y = 0; y < h_; ++y)
                for (int x = 0; x < w_; ++x)
                    for (const auto& [dx, dy] :
                         {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
                        add(sum, {face, x, y}, dx, dy);
        return sum;
    }

  private:
    struct Texel {
        int face, x, y;
    };

    FacePoint<double> centre(const Texel& t) const {
        return {t.face, (t.x + 0.5) / w_, (t.y + 0.5) / h_};
    }
    bool used(const Texel& t) const {
        return t.x >= 0 && t.y >= 0 && t.x < w_ && t.y < h_ && P::covers(centre(t));
    }
    Texel containing(const FacePoint<double>& p) const {
        return {p.face, std::clamp(static_cast<int>(p.s * w_), 0, w_ - 1),
                std::clamp(static_cast<int>(p.t * h_), 0, h_ - 1)};
    }
    double steepness(const Texel& a, const Texel& b) const {
        const Vec3d da = P::direction(centre(a)), db = P::direction(centre(b));
        const double angle = std::atan2(da.cross(db).length(), da.dot(db));
        if (angle < 1e-9) return 0;
        return step(level_.faces[a.face].rgb(a.x, a.y), level_.faces[b.face].rgb(b.x, b.y)) / angle;
    }
    void add(SeamSteps& sum, const Texel& here, int dx, int dy) const {
        const Texel outer{here.face, here.x + dx, here.y + dy};
        const Texel inner{here.face, here.x - dx, here.y - dy};
        if (!used(here) || used(outer) || !used(inner)) return;
        const Texel opposite = containing(P::wrap(centre(outer)));
        if (!used(opposite)) return;
        sum.across += steepness(here, opposite);
        sum.inside += steepness(here, inner);
    }

    const Level& level_;
    int w_, h_;
};

}  // namespace

void detail::check_map_size(Projection projection, int size) {
    const int height = size / aspect(projection);
    if (size < 1 || height < 1 || height * aspect(projection) != size)
        throw Error(Errc::usage,
                    fmt::format("size {}: a map of projection {} needs {}", size, name(projection),
                                aspect(projection) == 2 ? "an even width of 2 or more"
                                                        : "an edge of 1 texel or more"));
}

EnvironmentMap make_environment_map(Projection projection, int size) {
    detail::check_map_size(projection, size);
    const int width = size, height = size / aspect(projection);
    EnvironmentMap map{projection, default_axes(projection), {Level{}}};
    for (int i = 0; i < face_count(projection); ++i)
        map.levels[0].faces.emplace_back(width, height, 3);
    return map;
}

EnvironmentMap make_environment_map(const MapShape& shape) {
    EnvironmentMap map = make_environment_map(shape.projection, shape.size);
    map.axes = shape.axes;
    return map;
}

std::uint64_t environment_map_bytes(Projection projection, std::int64_t size) {
    const double texels = static_cast<double>(size) * static_cast<double>(size) /
                          aspect(projection) * face_count(projection);
    const double bytes = texels * 3 * sizeof(float);
    constexpr double most = 9e18;  // any more is no machine's, and would not fit the type
    return bytes < most ? static_cast<std::uint64_t>(bytes) : static_cast<std::uint64_t>(most);
}

Vec3d flux(const EnvironmentMap& map, int level) {
    Vec3d sum(0.0);
    detail::for_each_texel(map, level, [&](int face, int x, int y, double solid_angle) {
        sum += Vec3d(map.levels[level].faces[face].rgb(x, y)) * solid_angle;
    });
    return sum;
}

LevelStatistics statistics(const EnvironmentMap& map, int level) {
    detail::StatisticsSum sum;
    detail::for_each_texel(map, level, [&](int face, int x, int y, double solid_angle) {
        sum.add(map.levels[level].faces[face].rgb(x, y), solid_angle);
    });
    return sum.result();
}

double seam_ratio(const EnvironmentMap& map, int level) {
    const SeamSteps steps = visit(map.projection, [&](auto p) {
        using P = decltype(p);
        return P::seam_count > 0 ? SeamWalk<P>(map.levels[level]).walk() : SeamSteps{};
    });
    if (steps.inside > 0) return steps.across / steps.inside;
    return steps.across > 0 ? std::numeric_limits<double>::infinity() : 1;
}

}  // namespace mirrorball
