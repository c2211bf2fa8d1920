// Three passes:
//
//   1. every texel gets the mean of a grid of samples, weighted by the projection's density, that
//   are
//      no further apart than the environment's finest detail: one sample where texels are finer;
//   2. texels that differ from a neighbour are sampled again more densely: edges become smooth;
//   3. the disc of the sun, if there is one, is dealt out as points of equal solid angle, each to
//   the
//      texel that it falls into. So its flux is the same at every size, exactly.
//
// A texel reads only the environment and, in pass 2, the mask that pass 1 left: the same bits at
// any thread count.
#include "rasterise.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "core/parallel.h"
#include "core/part_of.h"

namespace mirrorball::detail {
namespace {

// A step between neighbours, relative to the brighter, and the samples along each side that it asks
// for. 36 samples leave an edge through a texel an error of about 2% of the step.
constexpr float kSlightStep = 0.12f, kStrongStep = 0.35f;
constexpr int kSlightSide = 3, kStrongSide = 6;

constexpr double kFirstPassShare = 0.6;  // of the progress

// The disc's points: so many per texel, but at least as many as its own darkening needs.
constexpr double kPointsPerTexel = 1024, kFewestPoints = 4096, kMostPoints = 1 << 22;

template <class P>
class Rasteriser {
  public:
    Rasteriser(const Environment& environment, EnvironmentMap& map)
        : environment_(environment),
          axes_(map.axes),
          faces_(map.levels[0].faces),
          width_(map.width()),
          height_(map.height()),
          solid_angles_(solid_angle_table(map.projection, width_, height_)),
          sides_(std::size_t{P::face_count} * width_ * height_) {}

    void run(const Progress& progress) {
        for_each_row([&](const Row& row) { draw_row(row); }, part_of(progress, 0, kFirstPassShare));
        for_each_row([&](const Row& row) { find_edges(row); }, {});
        for_each_row([&](const Row& row) { refine_row(row); },
                     part_of(progress, kFirstPassShare, 1));
        if (const auto disc = environment_.disc()) draw_disc(*disc);
    }

  private:
    // A row of texels of one face, and where its first one is in a list of all.
    struct Row {
        int face, y;
        std::size_t first;
    };
    void for_each_row(const std::function<void(const Row&)>& f, const Progress& progress) const {
        parallel_for(
            std::int64_t{P::face_count} * height_,
            [&](std::int64_t i) {
                f({static_cast<int>(i / height_), static_cast<int>(i % height_),
                   static_cast<std::size_t>(i) * width_});
            },
            progress);
    }

    // Samples along s and t.
    struct Grid {
        int s, t;
    };

    [[nodiscard]] double solid_angle(int x, int y) const {
        return solid_angles_[static_cast<std::size_t>(y) * width_ + x];
    }

    // No two samples further apart than the environment's detail. Where a map stretches without
    // bound (a sphere map's rim) the texel's solid angle bounds how many that can take.
    [[nodiscard]] Grid grid(int face, int x, int y) const {
        const FacePoint<double> centre{face, (x + 0.5) / width_, (y + 0.5) / height_};
        const Tangents<double> tangents = P::tangents(centre, P::direction(centre));
        const double detail = environment_.detail();
        double s = std::max(1.0, tangents.ds.length() / (width_ * detail));
        double t = std::max(1.0, tangents.dt.length() / (height_ * detail));
        const double most = 256 + 16 * solid_angle(x, y) / (detail * detail);
        if (s * t > most) {
            const double excess = std::sqrt(s * t / most);
            s = std::min(std::max(1.0, s / excess), most),
            t = std::min(std::max(1.0, t / excess), most);
        }
        return {static_cast<int>(std::ceil(s)), static_cast<int>(std::ceil(t))};
    }

    [[nodiscard]] Vec3d mean(int face, int x, int y, const Grid& grid) const {
        Vec3d sum(0);
        double weights = 0;
        for (int j = 0; j < grid.t; ++j) {
            for (int i = 0; i < grid.s; ++i) {
                // Each row of the grid is shifted against the next, and each column: an edge along
                // them passes the samples one by one.
                const double across = (i + (j + 0.5) / grid.t) / grid.s;
                const double down = (j + (i + 0.5) / grid.s) / grid.t;
                const FacePoint<double> p{face, (x + across) / width_, (y + down) / height_};
                const double weight = P::covers(p) ? P::density(p) : 0;
                if (weight == 0) continue;
                sum += sample(p) * weight;
                weights += weight;
            }
        }
        if (weights > 0) return sum / weights;
        // A sliver of the texel is used, and the grid fell beside it: go closer, then make do with
        // the direction that the centre stands for.
        if (grid.s * grid.t < 1024) return mean(face, x, y, {2 * grid.s, 2 * grid.t});
        return sample({face, (x + 0.5) / width_, (y + 0.5) / height_});
    }

    [[nodiscard]] Vec3d sample(const FacePoint<double>& p) const {
        return environment_.radiance(axes_.to_world(P::direction(p)));
    }

    void draw_row(const Row& row) {
        const auto& [face, y, first] = row;
        for (int x = 0; x < width_; ++x)
            if (solid_angle(x, y) > 0)
                faces_[face].set_rgb(x, y, Vec3f(mean(face, x, y, grid(face, x, y))));
    }

    // All texels are compared with their neighbours before pass 2 changes any.
    void find_edges(const Row& row) {
        const auto& [face, y, first] = row;
        for (int x = 0; x < width_; ++x) {
            if (solid_angle(x, y) == 0) continue;
            const Image& image = faces_[face];
            const float largest =
                std::max({step(image, x, y, x - 1, y), step(image, x, y, x + 1, y),
                          step(image, x, y, x, y - 1), step(image, x, y, x, y + 1)});
            sides_[first + x] = largest > kStrongStep   ? kStrongSide
                                : largest > kSlightStep ? kSlightSide
                                                        : 0;
        }
    }

    [[nodiscard]] float step(const Image& face, int x0, int y0, int x1, int y1) const {
        if (x1 < 0 || y1 < 0 || x1 >= width_ || y1 >= height_ || solid_angle(x1, y1) == 0) return 0;
        const Vec3f a = face.rgb(x0, y0), b = face.rgb(x1, y1);
        float largest = 0;
        for (int i = 0; i < 3; ++i)
            if (a[i] != b[i])
                largest = std::max(largest, std::abs(a[i] - b[i]) / std::max(a[i], b[i]));
        return largest;
    }

    void refine_row(const Row& row) {
        const auto& [face, y, first] = row;
        for (int x = 0; x < width_; ++x) {
            const int side = sides_[first + x];
            if (side == 0) continue;
            const Grid before = grid(face, x, y);
            const Grid after{std::max(before.s, side), std::max(before.t, side)};
            // Coarse texels have many samples already: a few more are not worth all of them again.
            if (after.s * after.t >= 2 * before.s * before.t)
                faces_[face].set_rgb(x, y, Vec3f(mean(face, x, y, after)));
        }
    }

    void draw_disc(const Disc& disc) {
        const Vec3d right = (std::abs(disc.direction.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0))
                                .cross(disc.direction)
                                .normalized();
        const Vec3d up = disc.direction.cross(right);
        // A whole texel's solid angle there, or a share of the mean one at a pole.
        const double density = std::max(P::density(P::project(axes_.to_map(disc.direction))),
                                        kPi / (2 * P::face_count));
        const double texels = disc.solid_angle() / density * width_ * height_;
        const int count =
            static_cast<int>(std::clamp(kPointsPerTexel * texels, kFewestPoints, kMostPoints));
        const double share = disc.solid_angle() / count;
        std::map<Texel, Vec3d> flux;  // in double, so that adding up loses nothing
        const double golden_angle = kPi * (3 - std::sqrt(5.0));
        for (int i = 0; i < count; ++i) {
            // Vogel's sunflower, with rings of equal solid angle: sin(theta/2) grows as sqrt(i)
            const double half_sine = std::sin(disc.radius / 2) * std::sqrt((i + 0.5) / count);
            const double sine = 2 * half_sine * std::sqrt(1 - half_sine * half_sine);
            const double turn = golden_angle * i;
            const Vec3d direction = disc.direction * (1 - 2 * half_sine * half_sine) +
                                    (right * std::cos(turn) + up * std::sin(turn)) * sine;
            Vec3d& sum = flux.try_emplace(texel_at(direction), Vec3d(0)).first->second;
            sum += environment_.disc_radiance(direction) * share;
        }
        for (const auto& [at, sum] : flux) {
            Image& face = faces_[at.face];
            face.set_rgb(at.x, at.y,
                         Vec3f(Vec3d(face.rgb(at.x, at.y)) + sum / solid_angle(at.x, at.y)));
        }
    }

    struct Texel {
        int face, x, y;
        auto operator<=>(const Texel&) const = default;
    };
    [[nodiscard]] Texel texel_at(const Vec3d& world) const {
        const FacePoint<double> p = P::project(axes_.to_map(world));
        return {p.face, std::clamp(static_cast<int>(p.s * width_), 0, width_ - 1),
                std::clamp(static_cast<int>(p.t * height_), 0, height_ - 1)};
    }

    const Environment& environment_;
    const Axes axes_;
    std::vector<Image>& faces_;
    const int width_, height_;
    const std::vector<double> solid_angles_;
    std::vector<std::uint8_t> sides_;  // samples along each side that pass 2 takes; 0: none
};

}  // namespace

double Disc::solid_angle() const {
    const double half_sine = std::sin(radius / 2);
    return 4 * kPi * half_sine * half_sine;
}

EnvironmentMap rasterise(const Environment& environment, Projection projection, int size,
                         const Axes& axes, const Progress& progress) {
    EnvironmentMap map = make_environment_map({projection, size, axes});
    visit(projection, [&]<class P>(P) { Rasteriser<P>(environment, map).run(progress); });
    return map;
}

}  // namespace mirrorball::detail
