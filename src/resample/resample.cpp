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

// An edge longer than this many source texels is cut; so is one that crosses this many the other way.
constexpr double kLongestEdge = 4;
constexpr double kMostSkew = 0.5;
// Below this many source texels per edge of the target the interpolation is seen, not the average.
constexpr double kMagnified = 0.5;
// Near a pole of the source its texels become slivers, and cells cut for their short side everywhere
// would be many more than there are texels: this many at most.
constexpr double kMostCellsPerSourceTexel = 4;
// A texel on the rim is cut so that the rim's course through it is seen.
constexpr int kRimCells = 16;

// A texel of the target, or a cell of one, in the source's frame; edges are differences of direction.
struct Patch {
    Vec3d centre, edge_s, edge_t;
    double solid_angle;  // up to a factor common to a texel's cells
};

struct Grid {
    int along_s = 1, along_t = 1;
    [[nodiscard]] bool cut() const { return along_s > 1 || along_t > 1; }
};

// What a patch is to the source: where it lies, how many source texels its two edges together reach
// along s and along t, and into how many cells it should be cut to be boxes.
struct Footprint {
    FacePoint<double> centre;
    double width, height;
    Grid grid;
};

// The target's half ---------------------------------------------------------------------------------

class Target {
  public:
    virtual ~Target() = default;
    virtual Patch texel(int face, int x, int y) const = 0;
    // Is it entirely in the used part?
    virtual bool whole(int face, int x, int y) const = 0;
    // The used cells of a texel; at least one.
    virtual void cells(int face, int x, int y, Grid grid, std::vector<Patch>& out) const = 0;
};

template <class P>
class TargetOf final : public Target {
  public:
    // Columns of target_to_source: the target's axes as the source sees them.
    TargetOf(int width, int height, const Axes& target_to_source)
        : width_(width), height_(height), to_source_(target_to_source) {}

    Patch texel(int face, int x, int y) const override {
        return patch(point(face, x, y, 0.5, 0.5), {});
    }

    bool whole(int face, int x, int y) const override {
        if constexpr (P::fills_square) return true;
        return P::covers(point(face, x, y, 0, 0)) && P::covers(point(face, x, y, 1, 0)) &&
               P::covers(point(face, x, y, 0, 1)) && P::covers(point(face, x, y, 1, 1));
    }

    void cells(int face, int x, int y, Grid grid, std::vector<Patch>& out) const override {
        out.clear();
        for (int j = 0; j < grid.along_t; ++j) {
            for (int i = 0; i < grid.along_s; ++i) {
                const FacePoint<double> p =
                    point(face, x, y, (i + 0.5) / grid.along_s, (j + 0.5) / grid.along_t);
                if (P::covers(p)) out.push_back(patch(p, grid));
            }
        }
        // a sliver that the rim cut off between the cells' centres
        if (out.empty()) out.push_back(patch(P::wrap(point(face, x, y, 0.5, 0.5)), grid));
    }

  private:
    FacePoint<double> point(int face, int x, int y, double fx, double fy) const {
        return {face, (x + fx) / width_, (y + fy) / height_};
    }
    Patch patch(const FacePoint<double>& p, Grid grid) const {
        const Vec3d centre = P::direction(p);
        const Tangents<double> tangents = P::tangents(p, centre);
        return {to_source_.to_world(centre),
                to_source_.to_world(tangents.ds / (static_cast<double>(width_) * grid.along_s)),
                to_source_.to_world(tangents.dt / (static_cast<double>(height_) * grid.along_t)),
                P::density(p)};
    }

    int width_, height_;
    Axes to_source_;
};

// The source's half ---------------------------------------------------------------------------------

class Source {
  public:
    virtual ~Source() = default;
    virtual Footprint footprint(const Patch& patch) const = 0;
    virtual Rgbx value(const Footprint& footprint) const = 0;
};

template <class P>
class SourceOf final : public Source {
  public:
    SourceOf(const Level& level, Interpolation interpolation)
        : sampler_(level), bicubic_(interpolation == Interpolation::bicubic) {}

    Footprint footprint(const Patch& patch) const override {
        const FacePoint<double> p = P::project(patch.centre);
        const Tangents<double> tangents = P::tangents(p, patch.centre);
        const Vec3d texel_s = tangents.ds / sampler_.width(), texel_t = tangents.dt / sampler_.height();
        // edge = u texel_s + v texel_t, from its dot products with both
        const double ss = texel_s.dot(texel_s), st = texel_s.dot(texel_t), tt = texel_t.dot(texel_t);
        const double determinant = std::max(ss * tt - st * st, 1e-12 * tt * tt);
        const double inverse = 1 / determinant;
        const auto in_texels = [&](const Vec3d& edge) {
            const double s = edge.dot(texel_s), t = edge.dot(texel_t);
            return Reach{std::min(std::abs(tt * s - st * t) * inverse, 1.0 * sampler_.width()),
                         std::min(std::abs(ss * t - st * s) * inverse, 1.0 * sampler_.height())};
        };
        const Reach s = in_texels(patch.edge_s), t = in_texels(patch.edge_t);
        Footprint f{p, s.s + t.s, s.t + t.t, {}};
        if (s.cuts() > 1 || t.cuts() > 1) {
            const double area = patch.edge_s.cross(patch.edge_t).length() / std::sqrt(determinant);
            f.grid = grid_of(s.cuts(), t.cuts(), area);
        }
        return f;
    }

    Rgbx value(const Footprint& f) const override {
        if (bicubic_ && std::max(f.width, f.height) <= kMagnified) return sampler_.bicubic(f.centre);
        constexpr double largest = detail::Sampler<P>::kLargestBox;
        return sampler_.box_mean(f.centre, std::min(f.width, largest), std::min(f.height, largest));
    }

  private:
    // How far an edge reaches along either axis, in source texels; not negative.
    struct Reach {
        double s, t;
        [[nodiscard]] double cuts() const {
            return std::max(std::max(s, t) / kLongestEdge, std::min(s, t) / kMostSkew);
        }
    };

    // `area` is that of the patch in source texels.
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

Vec3f mean_of_cells(const Source& source, const std::vector<Patch>& cells) {
    Vec3d sum(0.0);
    double weight = 0;
    for (const Patch& cell : cells) {
        const Rgbx value = source.value(source.footprint(cell));
        sum += Vec3d(value[0], value[1], value[2]) * cell.solid_angle;
        weight += cell.solid_angle;
    }
    return Vec3f(sum / weight);
}

void resample_row(const Target& target, const Source& source, int face, int y, Image& image,
                  const std::vector<double>& solid_angles) {
    thread_local std::vector<Patch> cells;
    for (int x = 0; x < image.width(); ++x) {
        if (solid_angles[static_cast<std::size_t>(y) * image.width() + x] == 0) continue;
        Footprint footprint = source.footprint(target.texel(face, x, y));
        const bool whole = target.whole(face, x, y);
        if (whole && !footprint.grid.cut()) {
            const Rgbx value = source.value(footprint);
            image.set_rgb(x, y, {value[0], value[1], value[2]});
            continue;
        }
        Grid& grid = footprint.grid;
        if (!whole)
            grid = {std::max(grid.along_s, kRimCells), std::max(grid.along_t, kRimCells)};
        target.cells(face, x, y, grid, cells);
        image.set_rgb(x, y, mean_of_cells(source, cells));
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
