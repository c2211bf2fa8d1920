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
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "core/parallel.h"
#include "core/vectorized.h"
#include "image/map_size.h"
#include "resample/across_edges.h"
#include "resample/rgbx.h"
#include "resample/symmetry.h"
#include "resample/weigh.h"

namespace mirrorball {
namespace {

using detail::Box;
using detail::BoxKind;
using detail::kBlock;
using detail::MovedLevel;
using detail::Rgbx;
using detail::Stencils;

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

struct CellGrid {
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
    [[nodiscard]] CellGrid grid(int i) const {
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
    virtual int cells(int face, int x, int y, CellGrid grid, int first, int owner,
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

    int cells(int face, int x, int y, CellGrid grid, int first, int owner,
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
    void append(Patches& out, const FacePoint<double>& p, CellGrid grid, int owner) const {
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
    // The box that stands for a patch.
    [[nodiscard]] virtual Box box(const Footprints& footprints, int i) const = 0;
    // What stencil k is worth, which reaches over an edge of its face.
    [[nodiscard]] virtual Rgbx across_edges(const Stencils& stencils, int k,
                                            const MovedLevel& level) const = 0;
};

template <class P>
class SourceOf final : public Source {
  public:
    SourceOf(int width, int height, Interpolation interpolation)
        : width_(width),
          height_(height),
          bicubic_(interpolation == Interpolation::bicubic) {}

    void footprints(const Patches& patches, Footprints& __restrict out) const override {
        const int count = patches.count;
        const double width = width_, height = height_;
        detail::vectorized([&]() MIRRORBALL_INLINE_BODY {
            for (int i = 0, n = count; i < n; ++i) measure(patches, i, width, height, out);
        });
    }

    Box box(const Footprints& f, int i) const override {
        const double larger = std::max(f.width[i], f.height[i]);
        Box box;
        box.kind = bicubic_ && larger <= kMagnified ? BoxKind::smooth : BoxKind::mean;
        box.face = static_cast<std::uint8_t>(f.face[i]);
        box.s = fixed_point(f.s[i]), box.t = fixed_point(f.t[i]);
        box.width = fixed_point_size(f.width[i]), box.height = fixed_point_size(f.height[i]);
        if constexpr (!P::fills_square) box.at_rim = at_rim(f, i);
        return box;
    }

    Rgbx across_edges(const Stencils& stencils, int k, const MovedLevel& level) const override {
        return detail::AcrossEdges<P>(level).weigh(stencils, k);
    }

  private:
    // Whether any of the texels that a box may see is an unused one.
    bool at_rim(const Footprints& f, int i) const {
        const double ds = (std::max(f.width[i], 2.0) / 2 + 2) / width_,
                     dt = (std::max(f.height[i], 2.0) / 2 + 2) / height_;
        const auto covered = [&](double s, double t) {
            return P::covers(FacePoint<double>{f.face[i], f.s[i] + s, f.t[i] + t});
        };
        return !covered(-ds, -dt) || !covered(ds, -dt) || !covered(-ds, dt) || !covered(ds, dt);
    }

    static std::uint32_t fixed_point(double s) {
        return static_cast<std::uint32_t>(std::clamp(s * 0x1p32 + 0.5, 0.0, 0x1p32 - 1));
    }
    static std::uint16_t fixed_point_size(double texels) {
        return static_cast<std::uint16_t>(
            std::max(1.0, std::min(texels, detail::kLargestBox) / detail::kBoxUnit + 0.5));
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

    int width_, height_;
    bool bicubic_;
};

// What a plan holds
// -----------------------------------------------------------------------------------

// What a row of a patch takes from the source: a box for each texel, and the cells of those that
// are cut, in the texels' order.
struct RowPlan {
    struct Use {
        int x;  // of the texel, in the patch
        float weight;
    };
    std::vector<Box> texels, cells;
    std::vector<Use> uses;  // of the cells

    [[nodiscard]] std::size_t bytes() const {
        return sizeof *this + (texels.capacity() + cells.capacity()) * sizeof(Box) +
               uses.capacity() * sizeof(Use);
    }
};

// Makes the plan of a row, a block of texels after the other. Texels that are boxes to the source
// are done at once; the cells of the others queue up, so that they, too, go by the block.
class RowPlanner {
  public:
    // `solid_angles` of the target's texels, empty if all are used.
    RowPlanner(const Target& target, const Source& source, const std::vector<double>& solid_angles,
               int target_width)
        : target_(target),
          source_(source),
          solid_angles_(solid_angles),
          target_width_(target_width) {}

    void plan(const detail::Patch& patch, int y, RowPlan& row) {
        row.texels.resize(patch.width);
        row.cells.clear();
        row.uses.clear();
        row_ = &row;
        for (int x0 = 0; x0 < patch.width; x0 += kBlock) {
            const int count = std::min(kBlock, patch.width - x0);
            first_x_ = x0;
            target_.texels(patch.face, patch.x + x0, patch.y + y, count, texels_);
            source_.footprints(texels_, footprints_);
            for (int i = 0; i < count; ++i)
                row.texels[x0 + i] = plan_texel(patch.face, patch.x + x0 + i, patch.y + y, i);
            finish_queue();
            share_out();
        }
    }

  private:
    Box plan_texel(int face, int x, int y, int i) {
        const bool all_used = solid_angles_.empty();
        if (!all_used && !(solid_angles_[static_cast<std::size_t>(y) * target_width_ + x] > 0))
            return {};
        const bool whole = all_used || target_.whole(face, x, y);
        if (whole && !footprints_.cut(i)) return source_.box(footprints_, i);
        CellGrid grid = footprints_.grid(i);
        if (!whole) grid = {std::max(grid.along_s, kRimCells), std::max(grid.along_t, kRimCells)};
        solid_angle_[i] = 0;
        bool any = false;
        for (int next = 0; next < grid.cell_count();) {
            const int before = queue_.count;
            next = target_.cells(face, x, y, grid, next, i, queue_);
            any = any || queue_.count > before;
            if (queue_.count == kBlock) finish_queue();
        }
        if (!any) target_.across_rim(face, x, y, i, queue_);
        if (queue_.count == kBlock) finish_queue();
        return {};
    }

    void finish_queue() {
        source_.footprints(queue_, queue_footprints_);
        for (int k = 0; k < queue_.count; ++k) {
            const int i = queue_.owner[k];
            row_->cells.push_back(source_.box(queue_footprints_, k));
            row_->uses.push_back({first_x_ + i, static_cast<float>(queue_.solid_angle[k])});
            solid_angle_[i] += queue_.solid_angle[k];
        }
        queue_.count = 0;
    }

    // Turns solid angles into shares of their texel's.
    void share_out() {
        for (std::size_t k = row_->uses.size(); k > 0 && row_->uses[k - 1].x >= first_x_; --k) {
            RowPlan::Use& use = row_->uses[k - 1];
            use.weight = static_cast<float>(use.weight / solid_angle_[use.x - first_x_]);
        }
    }

    const Target& target_;
    const Source& source_;
    const std::vector<double>& solid_angles_;
    int target_width_;
    RowPlan* row_ = nullptr;
    int first_x_ = 0;
    Patches texels_, queue_;
    Footprints footprints_, queue_footprints_;
    double solid_angle_[kBlock];  // of a cut texel's cells
};

// Runs the plan of a row, for all repeats of its patch, a block of stencils after the other. As a
// rule a block is texels side by side, a stencil each, and goes straight to the result. Where a
// texel is cut or its box is large, it has several, and its colour is their sum.
class RowRunner {
  public:
    RowRunner(const Source& source, const MovedLevel& from, Level& to)
        : source_(source),
          level_(from),
          to_(to) {}

    void run(const detail::Patch& patch, int y, const RowPlan& row) {
        patch_ = &patch, y_ = y;
        sums_.assign(patch.repeats.size(), Vec3d(0.0));
        const std::vector<RowPlan::Use>& uses = row.uses;
        std::size_t cell = 0;
        for (int x = 0; x < patch.width;) {
            // whole texels up to the next that is cut, then cut ones up to the next whole one
            const int first_x = x;
            x = cell < uses.size() ? uses[cell].x : patch.width;
            append(row.texels.data() + first_x, x - first_x, [&](int i) {
                return RowPlan::Use{first_x + i, 1};
            });
            const std::size_t first = cell;
            for (; cell < uses.size() && uses[cell].x <= x; ++cell) x = uses[cell].x + 1;
            append(row.cells.data() + first, static_cast<int>(cell - first),
                   [&](int i) { return uses[first + i]; });
        }
        finish_block(patch.width);
    }

  private:
    // use_of(i) says what box i is used for.
    template <class UseOf>
    void append(const Box* boxes, int count, const UseOf& use_of) {
        for (int done = 0; done < count;) {
            const int before = stencils_.count;
            const int more = detail::append_stencils(boxes + done, count - done, level_.width,
                                                     level_.height, stencils_, owners_);
            for (int k = before; k < stencils_.count; ++k) uses_[k] = use_of(done + owners_[k]);
            done += more;
            if (done < count) finish_block(use_of(done).x);
        }
    }

    // The next stencil is of texel next_x.
    void finish_block(int next_x) {
        const int count = stencils_.count;
        if (count == 0) return;
        const int first_x = uses_[0].x, last_x = uses_[count - 1].x;
        const bool goes_on = next_x == last_x;
        const bool one_each = count == last_x - first_x + 1 && !goes_on && !went_on_;
        for (std::size_t r = 0; r < patch_->repeats.size(); ++r) {
            const detail::Repeat& repeat = patch_->repeats[r];
            if (one_each) {
                weigh(repeat, repeat.flip_x, result(repeat, first_x, count));
            } else {
                weigh(repeat, false, values_);
                add_up(repeat, next_x, sums_[r]);
            }
        }
        went_on_ = goes_on;
        stencils_.clear();
    }

    // Colours of the stencils for a repeat.
    void weigh(const detail::Repeat& repeat, bool reversed, float* out) {
        level_.moves = repeat.source;
        int across[detail::kMostStencils];
        const int across_count = detail::weigh(stencils_, reversed, level_, out, across);
        for (int i = 0; i < across_count; ++i) {
            const int k = across[i];
            const Rgbx value = source_.across_edges(stencils_, k, level_);
            std::memcpy(out + 3 * (reversed ? stencils_.count - 1 - k : k), &value,
                        3 * sizeof(float));
        }
    }

    void add_up(const detail::Repeat& repeat, int next_x, Vec3d& sum) {
        for (int k = 0; k < stencils_.count; ++k) {
            const auto [x, weight] = uses_[k];
            const float* const value = values_ + 3 * k;
            sum += Vec3d(value[0], value[1], value[2]) * weight;
            if (x == (k + 1 < stencils_.count ? uses_[k + 1].x : next_x)) continue;
            const std::array rgb{static_cast<float>(sum.x), static_cast<float>(sum.y),
                                 static_cast<float>(sum.z)};
            std::copy(rgb.begin(), rgb.end(), result(repeat, x, 1));
            sum = Vec3d(0.0);
        }
    }

    // Where `count` texels of the row from x on belong.
    [[nodiscard]] float* result(const detail::Repeat& repeat, int x, int count) const {
        const int to_x = detail::mirrored(repeat.flip_x, patch_->x + x, count, to_.width()),
                  to_y = detail::mirrored(repeat.flip_y, patch_->y + y_, 1, to_.height());
        return to_.faces[repeat.face].at(to_x, to_y);
    }

    const Source& source_;
    MovedLevel level_;
    Level& to_;
    const detail::Patch* patch_ = nullptr;
    int y_ = 0;
    Stencils stencils_;
    int owners_[detail::kMostStencils];
    RowPlan::Use uses_[detail::kMostStencils];
    bool went_on_ = false;  // the first texel had stencils in the last block
    float values_[3 * detail::kMostStencils];
    std::vector<Vec3d> sums_;  // per repeat
};

// The target's axes in the source's frame.
Axes relative_axes(const Axes& target, const Axes& source) {
    return {source.to_map(target.x), source.to_map(target.y), source.to_map(target.z)};
}

void copy_level(const Level& from, Level& to) {
    const int height = from.height();
    detail::parallel_for(
        static_cast<std::int64_t>(from.faces.size()) * height, [&](std::int64_t i) {
            const int face = static_cast<int>(i / height), y = static_cast<int>(i % height);
            const std::span<const float> row = from.faces[face].row(y);
            std::copy(row.begin(), row.end(), to.faces[face].row(y).begin());
        });
}

void check_shape(const char* what, const EnvironmentMap& map, const MapShape& expected) {
    if (map.level_count() > 0 && shape_of(map) == expected) return;
    throw Error(
        Errc::usage,
        map.level_count() == 0
            ? fmt::format("{} of a resampling has no levels", what)
            : fmt::format("{} of a resampling is {} of size {} in axes {}; its plan is for "
                          "{} of size {} in axes {}",
                          what, name(map.projection), map.width(), to_string(map.axes),
                          name(expected.projection), expected.size, to_string(expected.axes)));
}

}  // namespace

MapShape shape_of(const EnvironmentMap& map) {
    return {map.projection, map.width(), map.axes};
}

// All that both ways of resampling share: rows of patches, planned and run one by one.
class Resampler::Plan {
  public:
    Plan(const MapShape& source, const MapShape& target, Interpolation interpolation)
        : source_shape_(source),
          target_shape_(target) {
        detail::check_map_size(source.projection, source.size);
        detail::check_map_size(target.projection, target.size);
        if (copies()) return;
        const detail::Grid from = grid(source), to = grid(target);
        const Axes to_source = relative_axes(target.axes, source.axes);
        target_width_ = to.width;
        target_ = visit(target.projection, [&](auto p) -> std::unique_ptr<Target> {
            return std::make_unique<TargetOf<decltype(p)>>(to.width, to.height, to_source);
        });
        source_ = visit(source.projection, [&](auto p) -> std::unique_ptr<Source> {
            return std::make_unique<SourceOf<decltype(p)>>(from.width, from.height, interpolation);
        });
        if (!target_->all_whole())
            solid_angles_ = solid_angle_table(target.projection, to.width, to.height);
        patches_ = detail::find_patches(to, from, to_source);
        for (std::size_t p = 0; p < patches_.size(); ++p)
            for (int y = 0; y < patches_[p].height; ++y) row_places_.push_back({p, y});
    }

    void keep_rows() {
        rows_.resize(row_places_.size());
        detail::parallel_for(static_cast<std::int64_t>(rows_.size()), [&](std::int64_t i) {
            plan_row(i, rows_[i]);
            rows_[i].cells.shrink_to_fit();
            rows_[i].uses.shrink_to_fit();
        });
        magnifies_ = smooth_count() > texel_count(source_shape_);
    }

    void run(const EnvironmentMap& source, EnvironmentMap& result, const Progress& progress) const {
        check_shape("the source", source, source_shape_);
        check_shape("the result", result, target_shape_);
        if (copies()) return copy_level(source.levels[0], result.levels[0]);
        MovedLevel from = moved_level(source.levels[0]);
        const ZeroedFloats slopes = magnifies_ ? find_slopes(from) : ZeroedFloats();
        detail::parallel_for(
            static_cast<std::int64_t>(row_places_.size()),
            [&](std::int64_t i) {
                const auto [p, y] = row_places_[i];
                RowRunner runner(*source_, from, result.levels[0]);
                if (!rows_.empty()) return runner.run(patches_[p], y, rows_[i]);
                RowPlan row;
                plan_row(i, row);
                runner.run(patches_[p], y, row);
            },
            progress);
    }

    [[nodiscard]] EnvironmentMap make_result() const {
        EnvironmentMap result = make_environment_map(target_shape_.projection, target_shape_.size);
        result.axes = target_shape_.axes;
        return result;
    }

    [[nodiscard]] std::size_t bytes() const {
        std::size_t sum = sizeof *this + solid_angles_.capacity() * sizeof(double) +
                          row_places_.capacity() * sizeof(RowPlace);
        for (const RowPlan& row : rows_) sum += row.bytes();
        return sum;
    }

  private:
    struct RowPlace {
        std::size_t patch;
        int y;
    };

    static detail::Grid grid(const MapShape& shape) {
        return {shape.projection, shape.size, shape.size / aspect(shape.projection)};
    }
    [[nodiscard]] bool copies() const { return source_shape_ == target_shape_; }

    [[nodiscard]] std::int64_t smooth_count() const {
        std::int64_t sum = 0;
        for (std::size_t i = 0; i < rows_.size(); ++i)
            sum += std::count_if(rows_[i].texels.begin(), rows_[i].texels.end(),
                                 [](const Box& box) { return box.kind == BoxKind::smooth; }) *
                   std::ssize(patches_[row_places_[i].patch].repeats);
        return sum;
    }
    static std::int64_t texel_count(const MapShape& shape) {
        const detail::Grid size = grid(shape);
        return std::int64_t{size.width} * size.height * face_count(shape.projection);
    }

    static MovedLevel moved_level(const Level& level) {
        MovedLevel moved;
        for (std::size_t face = 0; face < level.faces.size(); ++face)
            moved.faces[face] = level.faces[face].at(0, 0);
        moved.width = level.width(), moved.height = level.height();
        return moved;
    }

    // Slopes along columns, of all texels but those of the first and last rows, which have none
    // above or below.
    [[nodiscard]] ZeroedFloats find_slopes(MovedLevel& level) const {
        const std::size_t row_size = std::size_t{3} * level.width,
                          face_size = row_size * level.height;
        const int faces = face_count(source_shape_.projection),
                  rows = std::max(level.height - 2, 0);
        ZeroedFloats slopes(face_size * faces + 1);  // texels are read as four floats
        for (int face = 0; face < faces; ++face)
            level.slopes[face] = slopes.data() + face * face_size;
        detail::parallel_for(std::int64_t{faces} * rows, [&](std::int64_t i) {
            const std::size_t face = i / rows, first = (1 + i % rows) * row_size;
            detail::find_slopes(level.faces[face] + first, level.width,
                                slopes.data() + face * face_size + first);
        });
        return slopes;
    }

    void plan_row(std::int64_t i, RowPlan& row) const {
        const auto [p, y] = row_places_[i];
        RowPlanner(*target_, *source_, solid_angles_, target_width_).plan(patches_[p], y, row);
    }

    MapShape source_shape_, target_shape_;
    std::unique_ptr<Target> target_;
    std::unique_ptr<Source> source_;
    int target_width_ = 0;
    std::vector<double> solid_angles_;  // where the target has unused texels
    std::vector<detail::Patch> patches_;
    std::vector<RowPlace> row_places_;
    std::vector<RowPlan> rows_;  // empty: planned as they are run
    bool magnifies_ = false;  // so many texels are smooth that slopes are worth finding beforehand
};

Resampler::Resampler(const MapShape& source, const MapShape& target, Interpolation interpolation) {
    auto plan = std::make_shared<Plan>(source, target, interpolation);
    plan->keep_rows();
    plan_ = std::move(plan);
}

EnvironmentMap Resampler::operator()(const EnvironmentMap& source, const Progress& progress) const {
    EnvironmentMap result = plan_->make_result();
    plan_->run(source, result, progress);
    return result;
}

void Resampler::operator()(const EnvironmentMap& source, EnvironmentMap& result,
                           const Progress& progress) const {
    plan_->run(source, result, progress);
}

std::size_t Resampler::bytes() const {
    return plan_->bytes();
}

EnvironmentMap resample(const EnvironmentMap& source, Projection projection, int size,
                        const Axes& axes, const ResampleOptions& options) {
    const Resampler::Plan plan(shape_of(source), {projection, size, axes}, options.interpolation);
    EnvironmentMap result = plan.make_result();
    plan.run(source, result, options.progress);
    return result;
}

}  // namespace mirrorball
