// Resampling in two halves that know nothing of each other's projection: the target knows where its
// texels lie on the sphere, the source what light comes from there. They meet in directions.
//
// For each texel of the target, its edges are vectors on the sphere; the source measures them in its
// own texels. In the usual case that box of source texels is averaged as it stands. A box that lies
// askew to the source's grid, or is large, is cut into a grid of cells that are boxes well enough.
// Where the target is the finer one, an edge is a fraction of a source texel and a smooth
// interpolation takes the place of the average.
//
// How exact that is: docs/theory/resampling.md.
#include <mirrorball/resample.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/parallel.h"
#include "resample/sampler.h"

namespace mirrorball {
namespace {

using detail::Rgbx;

// A cell's edge may cross this many source texels the other way before it is cut.
constexpr double kMostSkew = 0.5;
// Below this many source texels per edge of the target the interpolation is seen, not the average.
constexpr double kMagnified = 0.5;
// Near a pole of the source its texels become slivers, and cells cut for their short side everywhere
// would be many more than there are texels: this many at most.
constexpr double kMostCellsPerSourceTexel = 4;

// A texel of the target in the source's frame; its edges are differences of direction.
struct TargetTexel {
    Vec3d centre, edge_s, edge_t;
    bool whole;  // entirely in the used part
};

struct Cell {
    Vec3d direction;
    double solid_angle;
};

struct Grid {
    int along_s = 1, along_t = 1;
    [[nodiscard]] bool cut() const { return along_s > 1 || along_t > 1; }
};

// What a texel of the target is to the source: where it lies, how many source texels its two edges
// reach along s and along t (not negative), and into how many cells it should be cut.
struct Footprint {
    FacePoint<double> centre;
    struct {
        double s, t;
    } edge_s, edge_t;
    Grid grid;
};

// The target's half ---------------------------------------------------------------------------------

class Target {
  public:
    virtual ~Target() = default;
    virtual void describe_row(int face, int y, std::vector<TargetTexel>& row) const = 0;
    // The used cells of one texel's grid, solid angles up to a common factor; at least one.
    virtual void cut_texel(int face, int x, int y, Grid grid, std::vector<Cell>& out) const = 0;
};

template <class P>
class TargetOf final : public Target {
  public:
    // Columns of target_to_source: the target's axes as the source sees them.
    TargetOf(int width, int height, const Axes& target_to_source)
        : width_(width), height_(height), to_source_(target_to_source) {}

    void describe_row(int face, int y, std::vector<TargetTexel>& row) const override {
        row.resize(width_);
        for (int x = 0; x < width_; ++x) {
            const FacePoint<double> p = point(face, x, y, 0.5, 0.5);
            const Vec3d centre = P::direction(p);
            const Tangents<double> tangents = P::tangents(p, centre);
            row[x] = {to_source_.to_world(centre),
                      to_source_.to_world(tangents.ds / width_),
                      to_source_.to_world(tangents.dt / height_), whole(face, x, y)};
        }
    }

    void cut_texel(int face, int x, int y, Grid grid, std::vector<Cell>& out) const override {
        out.clear();
        for (int j = 0; j < grid.along_t; ++j) {
            for (int i = 0; i < grid.along_s; ++i) {
                const FacePoint<double> p =
                    point(face, x, y, (i + 0.5) / grid.along_s, (j + 0.5) / grid.along_t);
                if (!P::covers(p)) continue;
                out.push_back({to_source_.to_world(P::direction(p)), P::density(p)});
            }
        }
        if (!out.empty()) return;
        // a sliver that the rim cut off between the samples
        const FacePoint<double> p = P::wrap(point(face, x, y, 0.5, 0.5));
        out.push_back({to_source_.to_world(P::direction(p)), 1});
    }

  private:
    FacePoint<double> point(int face, int x, int y, double fx, double fy) const {
        return {face, (x + fx) / width_, (y + fy) / height_};
    }
    bool whole(int face, int x, int y) const {
        if constexpr (P::fills_square) return true;
        return P::covers(point(face, x, y, 0, 0)) && P::covers(point(face, x, y, 1, 0)) &&
               P::covers(point(face, x, y, 0, 1)) && P::covers(point(face, x, y, 1, 1));
    }

    int width_, height_;
    Axes to_source_;
};

// The source's half ---------------------------------------------------------------------------------

class Source {
  public:
    virtual ~Source() = default;
    virtual Footprint footprint(const TargetTexel& texel) const = 0;
    virtual Rgbx value(const Footprint& footprint) const = 0;
    virtual Rgbx value(const Footprint& footprint, const std::vector<Cell>& cells) const = 0;
};

template <class P>
class SourceOf final : public Source {
  public:
    SourceOf(const Level& level, Interpolation interpolation)
        : sampler_(level), bicubic_(interpolation == Interpolation::bicubic) {}

    Footprint footprint(const TargetTexel& texel) const override {
        const FacePoint<double> p = P::project(texel.centre);
        const Tangents<double> tangents = P::tangents(p, texel.centre);
        const Vec3d texel_s = tangents.ds / sampler_.width(), texel_t = tangents.dt / sampler_.height();
        // edge = u texel_s + v texel_t, from its dot products with both
        const double ss = texel_s.dot(texel_s), st = texel_s.dot(texel_t), tt = texel_t.dot(texel_t);
        const double determinant = std::max(ss * tt - st * st, 1e-12 * tt * tt);
        const double inverse = 1 / determinant;
        Footprint f{p, {}, {}, {}};
        for (const auto& [edge, step] : {std::pair(&texel.edge_s, &f.edge_s),
                                         std::pair(&texel.edge_t, &f.edge_t)}) {
            const double s = edge->dot(texel_s), t = edge->dot(texel_t);
            step->s = std::min(std::abs(tt * s - st * t) * inverse, 1.0 * sampler_.width());
            step->t = std::min(std::abs(ss * t - st * s) * inverse, 1.0 * sampler_.height());
        }
        const double along_s = cuts(f.edge_s.s, f.edge_s.t), along_t = cuts(f.edge_t.s, f.edge_t.t);
        if (along_s > 1 || along_t > 1) {
            const double area = texel.edge_s.cross(texel.edge_t).length() / std::sqrt(determinant);
            f.grid = grid_of(along_s, along_t, area);
        }
        return f;
    }

    Rgbx value(const Footprint& f) const override {
        const double width = f.edge_s.s + f.edge_t.s, height = f.edge_s.t + f.edge_t.t;
        if (bicubic_ && std::max(width, height) <= kMagnified) return sampler_.bicubic(f.centre);
        return sampler_.box_mean(f.centre, width, height);
    }

    Rgbx value(const Footprint& f, const std::vector<Cell>& cells) const override {
        const auto extent = [&](double along_s, double along_t) {
            const double sum = along_s / f.grid.along_s + along_t / f.grid.along_t;
            return std::min(sum, detail::Sampler<P>::kLargestBox);
        };
        const double width = extent(f.edge_s.s, f.edge_t.s), height = extent(f.edge_s.t, f.edge_t.t);
        double sum[3] = {}, weight = 0;
        for (const Cell& cell : cells) {
            const Rgbx mean = sampler_.box_mean(P::project(cell.direction), width, height);
            for (int c = 0; c < 3; ++c) sum[c] += cell.solid_angle * mean[c];
            weight += cell.solid_angle;
        }
        Rgbx mean{};
        for (int c = 0; c < 3; ++c) mean[c] = static_cast<float>(sum[c] / weight);
        return mean;
    }

  private:
    static double cuts(double s, double t) {
        return std::max(std::max(s, t) / (detail::Sampler<P>::kLargestBox / 2),
                        std::min(s, t) / kMostSkew);
    }

    // `area` is that of the texel in source texels.
    static Grid grid_of(double along_s, double along_t, double area) {
        along_s = std::max(1.0, along_s), along_t = std::max(1.0, along_t);
        const double excess =
            std::sqrt(along_s * along_t / (kMostCellsPerSourceTexel * std::max(1.0, area)));
        if (excess > 1) {
            along_s = std::max(1.0, along_s / excess);
            along_t = std::max(1.0, along_t / excess);
        }
        return {static_cast<int>(std::ceil(along_s)), static_cast<int>(std::ceil(along_t))};
    }

    detail::Sampler<P> sampler_;
    bool bicubic_;
};

// Together ------------------------------------------------------------------------------------------

void resample_row(const Target& target, const Source& source, int face, int y, Image& image,
                  const std::vector<double>& solid_angles) {
    thread_local std::vector<TargetTexel> row;
    thread_local std::vector<Cell> cells;
    target.describe_row(face, y, row);
    for (int x = 0; x < image.width(); ++x) {
        if (solid_angles[static_cast<std::size_t>(y) * image.width() + x] == 0) continue;
        Footprint footprint = source.footprint(row[x]);
        Rgbx value;
        if (row[x].whole && !footprint.grid.cut()) {
            value = source.value(footprint);
        } else {
            Grid& grid = footprint.grid;
            // enough of them that the rim's course through the texel is seen
            if (!row[x].whole) grid = {std::max(grid.along_s, 4), std::max(grid.along_t, 4)};
            target.cut_texel(face, x, y, grid, cells);
            value = source.value(footprint, cells);
        }
        image.set_rgb(x, y, {value[0], value[1], value[2]});
    }
}

// The target's axes in the source's frame.
Axes relative_axes(const Axes& target, const Axes& source) {
    return {source.to_map(target.x), source.to_map(target.y), source.to_map(target.z)};
}

}  // namespace

EnvironmentMap resample(const EnvironmentMap& source, Projection projection, int size,
                        const Axes& axes, const ResampleOptions& options) {
    EnvironmentMap result = make_environment_map(projection, size);
    result.axes = axes;
    if (source.projection == projection && source.width() == size && source.axes == axes) {
        result.levels[0] = source.levels[0];
        return result;
    }
    const int width = result.width(), height = result.height();
    const Axes to_source = relative_axes(axes, source.axes);
    const auto target = visit(projection, [&](auto p) -> std::unique_ptr<Target> {
        return std::make_unique<TargetOf<decltype(p)>>(width, height, to_source);
    });
    const auto reader = visit(source.projection, [&](auto p) -> std::unique_ptr<Source> {
        return std::make_unique<SourceOf<decltype(p)>>(source.levels[0], options.interpolation);
    });
    const std::vector<double> solid_angles = solid_angle_table(projection, width, height);
    detail::parallel_for(
        std::int64_t{face_count(projection)} * height,
        [&](std::int64_t i) {
            const int face = static_cast<int>(i / height), y = static_cast<int>(i % height);
            resample_row(*target, *reader, face, y, result.levels[0].faces[face], solid_angles);
        },
        options.progress);
    return result;
}

}  // namespace mirrorball
