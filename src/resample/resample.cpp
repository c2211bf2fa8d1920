// Resampling in two halves that know nothing of each other's projection: the target knows where its
// texels lie on the sphere, the source what light comes from there. They meet in directions.
//
// For each texel of the target, its edges are vectors on the sphere; the source measures them in
// its own texels. In the usual case that box of source texels is averaged as it stands. A box that
// lies askew to the source's grid, or is large, is cut into a grid of cells that are boxes well
// enough. Where the target is the finer one, an edge is a fraction of a source texel and a smooth
// interpolation takes the place of the average.
//
// How exact that is: docs/theory/resampling.md.
#include <mirrorball/resample.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "core/parallel.h"
#include "core/vectorized.h"
#include "resample/sampler.h"

namespace mirrorball {
namespace {

using detail::Rgbx;

// An edge longer than this many source texels is cut; so is one that crosses this many the other
// way.
constexpr double kLongestEdge = 4;
constexpr double kMostSkew = 0.5;
// Below this many source texels per edge of the target the interpolation is seen, not the average.
constexpr double kMagnified = 0.5;
// Near a pole of the source its texels become slivers, and cells cut for their short side
// everywhere would be many more than there are texels: this many at most.
constexpr double kMostCellsPerSourceTexel = 4;
// A texel on the rim is cut so that the rim's course through it is seen.
constexpr int kRimCells = 16;

constexpr int kBlock = 64;  // texels or cells that are worked out together, in vector code

// Texels of the target, or cells of one, as the source sees them: where their centres lie on the
// sphere, and their two edges as differences of direction.
struct Patches {
    struct Vectors {
        double x[kBlock], y[kBlock], z[kBlock];

        void set(int i, const Vec3d& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
        [[nodiscard]] Vec3d operator[](int i) const { return {x[i], y[i], z[i]}; }
    };
    int count = 0;
    Vectors centre, edge_s, edge_t;
    double solid_angle[kBlock];  // cells': up to a factor common to a texel's
    int owner[kBlock];           // cells': the texel that they belong to, by its place in its block
};

struct Grid {
    int along_s = 1, along_t = 1;
    [[nodiscard]] int cell_count() const { return along_s * along_t; }
};

// What patches are to the source: where their centres lie, how many source texels their edges
// together reach along s and along t, and how often each edge should be cut to make boxes of them.
struct Footprints {
    int face[kBlock];
    double s[kBlock], t[kBlock];
    double width[kBlock], height[kBlock];
    double cuts_s[kBlock], cuts_t[kBlock];
    double area[kBlock];  // in source texels

    [[nodiscard]] bool cut(int i) const { return cuts_s[i] > 1 || cuts_t[i] > 1; }
    // The cells to cut patch i into.
    [[nodiscard]] Grid grid(int i) const {
        double along_s = std::max(1.0, cuts_s[i]), along_t = std::max(1.0, cuts_t[i]);
        const double most = kMostCellsPerSourceTexel * std::max(1.0, area[i]);
        const double excess = std::sqrt(along_s * along_t / most);
        if (excess > 1) {
            along_s = std::max(1.0, along_s / excess);
            along_t = std::max(1.0, along_t / excess);
        }
        return {static_cast<int>(std::ceil(along_s)), static_cast<int>(std::ceil(along_t))};
    }
};

// The target's half
// ---------------------------------------------------------------------------------

class Target {
  public:
    virtual ~Target() = default;
    // `count` texels of a row, from x on.
    virtual void texels(int face, int x, int y, int count, Patches& out) const = 0;
    // Are all texels entirely in the used part? Is this one?
    virtual bool all_whole() const = 0;
    virtual bool whole(int face, int x, int y) const = 0;
    // Appends the used ones among the cells of a texel, from number `first` on, until the block is
    // full; the number to go on from.
    virtual int cells(int face, int x, int y, Grid grid, int first, int owner,
                      Patches& out) const = 0;
    // For a sliver that the rim cut off between all cells' centres: the place across the rim.
    virtual void across_rim(int face, int x, int y, int owner, Patches& out) const = 0;
};

template <class P>
class TargetOf final : public Target {
  public:
    // Columns of target_to_source: the target's axes as the source sees them.
    TargetOf(int width, int height, const Axes& target_to_source)
        : width_(width),
          height_(height),
          to_source_(target_to_source) {}

    void texels(int face, int x, int y, int count, Patches& __restrict out) const override {
        out.count = count;
        const Axes to_source = to_source_;
        const double width = width_, height = height_;
        detail::vectorized([&]() MIRRORBALL_INLINE_BODY {
            for (int i = 0, n = count; i < n; ++i) {
                const FacePoint<double> p{face, (x + i + 0.5) / width, (y + 0.5) / height};
                const Vec3d centre = P::direction(p);
                const Tangents<double> tangents = P::tangents(p, centre);
                out.centre.set(i, to_source.to_world(centre));
                out.edge_s.set(i, to_source.to_world(tangents.ds / width));
                out.edge_t.set(i, to_source.to_world(tangents.dt / height));
            }
        });
    }

    bool all_whole() const override { return P::fills_square; }
    bool whole(int face, int x, int y) const override {
        return P::covers(point(face, x, y, 0, 0)) && P::covers(point(face, x, y, 1, 0)) &&
               P::covers(point(face, x, y, 0, 1)) && P::covers(point(face, x, y, 1, 1));
    }

    int cells(int face, int x, int y, Grid grid, int first, int owner,
              Patches& out) const override {
        int next = first;
        for (; next < grid.cell_count() && out.count < kBlock; ++next) {
            const int i = next % grid.along_s, j = next / grid.along_s;
            const FacePoint<double> p =
                point(face, x, y, (i + 0.5) / grid.along_s, (j + 0.5) / grid.along_t);
            if (P::covers(p)) append(out, p, grid, owner);
        }
        return next;
    }

    void across_rim(int face, int x, int y, int owner, Patches& out) const override {
        append(out, P::wrap(point(face, x, y, 0.5, 0.5)), {kRimCells, kRimCells}, owner);
    }

  private:
    FacePoint<double> point(int face, int x, int y, double fx, double fy) const {
        return {face, (x + fx) / width_, (y + fy) / height_};
    }
    void append(Patches& out, const FacePoint<double>& p, Grid grid, int owner) const {
        const Vec3d centre = P::direction(p);
        const Tangents<double> tangents = P::tangents(p, centre);
        const int i = out.count++;
        out.centre.set(i, to_source_.to_world(centre));
        out.edge_s.set(i, to_source_.to_world(tangents.ds / (1.0 * width_ * grid.along_s)));
        out.edge_t.set(i, to_source_.to_world(tangents.dt / (1.0 * height_ * grid.along_t)));
        out.solid_angle[i] = P::density(p);
        out.owner[i] = owner;
    }

    int width_, height_;
    Axes to_source_;
};

// The source's half
// ---------------------------------------------------------------------------------

class Source {
  public:
    virtual ~Source() = default;
    virtual void footprints(const Patches& patches, Footprints& out) const = 0;
    // The mean over each of the first `count` patches as one box; of `uncut` ones only, if asked.
    virtual void values(const Footprints& footprints, int count, bool uncut, Rgbx* out) const = 0;
};

template <class P>
class SourceOf final : public Source {
  public:
    SourceOf(const Level& level, Interpolation interpolation)
        : sampler_(level),
          bicubic_(interpolation == Interpolation::bicubic) {}

    void footprints(const Patches& patches, Footprints& __restrict out) const override {
        const int count = patches.count;
        const double width = sampler_.width(), height = sampler_.height();
        detail::vectorized([&]() MIRRORBALL_INLINE_BODY {
            for (int i = 0, n = count; i < n; ++i) measure(patches, i, width, height, out);
        });
    }

    void values(const Footprints& f, int count, bool uncut, Rgbx* out) const override {
        detail::vectorized([&]() MIRRORBALL_INLINE_BODY {
            for (int i = 0; i < count; ++i)
                if (!uncut || !f.cut(i)) out[i] = value(f, i);
        });
    }

  private:
    Rgbx value(const Footprints& f, int i) const {
        const FacePoint<double> centre{f.face[i], f.s[i], f.t[i]};
        if (bicubic_ && std::max(f.width[i], f.height[i]) <= kMagnified)
            return sampler_.bicubic(centre);
        constexpr double largest = detail::Sampler<P>::kLargestBox;
        return sampler_.box_mean(centre, std::min(f.width[i], largest),
                                 std::min(f.height[i], largest));
    }

    // How far an edge reaches along either axis, in source texels; not negative.
    struct Reach {
        double s, t;
        [[nodiscard]] double cuts() const {
            const double longer = s > t ? s : t, shorter = s > t ? t : s;
            return std::max(longer * (1 / kLongestEdge), shorter * (1 / kMostSkew));
        }
    };

    [[gnu::always_inline]] static void measure(const Patches& patches, int i, double width,
                                               double height, Footprints& __restrict out) {
        const Vec3d centre = patches.centre[i], edge_s = patches.edge_s[i],
                    edge_t = patches.edge_t[i];
        const FacePoint<double> p = P::project(centre);
        const Tangents<double> tangents = P::tangents(p, centre);
        const Vec3d texel_s = tangents.ds / width, texel_t = tangents.dt / height;
        // edge = u texel_s + v texel_t, from its dot products with both
        const double ss = texel_s.dot(texel_s), st = texel_s.dot(texel_t),
                     tt = texel_t.dot(texel_t);
        const double determinant = std::max(ss * tt - st * st, 1e-12 * tt * tt);
        const double inverse = 1 / determinant;
        const auto in_texels = [&](const Vec3d& edge) MIRRORBALL_INLINE_BODY {
            const double s = edge.dot(texel_s), t = edge.dot(texel_t);
            return Reach{std::min(std::abs(tt * s - st * t) * inverse, width),
                         std::min(std::abs(ss * t - st * s) * inverse, height)};
        };
        const Reach s = in_texels(edge_s), t = in_texels(edge_t);
        const Vec3d normal = edge_s.cross(edge_t);
        out.face[i] = p.face;
        out.s[i] = p.s, out.t[i] = p.t;
        out.width[i] = s.s + t.s, out.height[i] = s.t + t.t;
        out.cuts_s[i] = s.cuts(), out.cuts_t[i] = t.cuts();
        out.area[i] = std::sqrt(normal.dot(normal) * inverse);
    }

    detail::Sampler<P> sampler_;
    bool bicubic_;
};

// Together
// ------------------------------------------------------------------------------------------

// One row of the target's texels at a time, a block after the other. Texels that are boxes to the
// source are done at once; the cells of the others queue up, so that they, too, go by the block.
class RowResampler {
  public:
    RowResampler(const Target& target, const Source& source)
        : target_(target),
          source_(source),
          all_whole_(target.all_whole()) {}

    void resample(int face, int y, Image& image, std::span<const double> solid_angles) {
        for (int x0 = 0; x0 < image.width(); x0 += kBlock) {
            const int count = std::min(kBlock, image.width() - x0);
            target_.texels(face, x0, y, count, texels_);
            source_.footprints(texels_, footprints_);
            source_.values(footprints_, count, true, values_);
            for (int i = 0; i < count; ++i) {
                is_cut_[i] = false;
                if (solid_angles[x0 + i] > 0) queue_cells(face, x0 + i, y, i);
            }
            finish_queue();
            for (int i = 0; i < count; ++i)
                if (solid_angles[x0 + i] > 0) image.set_rgb(x0 + i, y, value(i));
        }
    }

  private:
    void queue_cells(int face, int x, int y, int i) {
        const bool whole = all_whole_ || target_.whole(face, x, y);
        if (whole && !footprints_.cut(i)) return;
        Grid grid = footprints_.grid(i);
        if (!whole) grid = {std::max(grid.along_s, kRimCells), std::max(grid.along_t, kRimCells)};
        is_cut_[i] = true;
        sum_[i] = Vec3d(0.0);
        weight_[i] = 0;
        bool any = false;
        for (int next = 0; next < grid.cell_count();) {
            const int before = queue_.count;
            next = target_.cells(face, x, y, grid, next, i, queue_);
            any = any || queue_.count > before;
            if (queue_.count == kBlock) finish_queue();
        }
        if (any) return;
        target_.across_rim(face, x, y, i, queue_);
        if (queue_.count == kBlock) finish_queue();
    }

    void finish_queue() {
        source_.footprints(queue_, queue_footprints_);
        source_.values(queue_footprints_, queue_.count, false, queue_values_);
        for (int k = 0; k < queue_.count; ++k) {
            const Rgbx& value = queue_values_[k];
            const int i = queue_.owner[k];
            sum_[i] += Vec3d(value[0], value[1], value[2]) * queue_.solid_angle[k];
            weight_[i] += queue_.solid_angle[k];
        }
        queue_.count = 0;
    }

    [[nodiscard]] Vec3f value(int i) const {
        if (is_cut_[i]) return Vec3f(sum_[i] / weight_[i]);
        return {values_[i][0], values_[i][1], values_[i][2]};
    }

    const Target& target_;
    const Source& source_;
    bool all_whole_;
    Patches texels_, queue_;
    Footprints footprints_, queue_footprints_;
    Rgbx values_[kBlock], queue_values_[kBlock];
    bool is_cut_[kBlock];
    Vec3d sum_[kBlock];
    double weight_[kBlock];
};

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
            const std::span row(solid_angles.data() + static_cast<std::size_t>(y) * width,
                                static_cast<std::size_t>(width));
            RowResampler(*target, *reader).resample(face, y, result.levels[0].faces[face], row);
        },
        options.progress);
    return result;
}

}  // namespace mirrorball
