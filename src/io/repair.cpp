#include "repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "texel_use.h"

namespace mirrorball::detail {
namespace {

bool is_finite(const Vec3f& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

TexelFaults row_faults(const Level& level, Projection projection, int face, int y) {
    const Image& image = level.faces[face];
    const int width = image.width();
    TexelFaults faults;
    for (int x = 0; x < width; ++x) {
        const Vec3f c = image.rgb(x, y);
        const float least = std::min({c.x, c.y, c.z});
        const bool finite = is_finite(c);
        // most texels are well, and are not asked whether they are used
        if (finite && least >= 0) continue;
        if (texel_solid_angle(projection, width, image.height(), x, y) == 0) continue;
        if (!finite) {
            if (faults.non_finite_count++ == 0) faults.first_non_finite = {face, x, y};
        } else {
            ++faults.negative_count;
            faults.smallest = std::min(faults.smallest, least);
        }
    }
    return faults;
}

// The texels of a level as one list, face by face and row by row, and their neighbours across
// edges.
class Neighbourhood {
  public:
    Neighbourhood(Projection projection, const Level& level)
        : projection_(projection),
          width_(level.width()),
          height_(level.height()) {}

    [[nodiscard]] std::int64_t index(const TexelPosition& t) const {
        return (std::int64_t{t.face} * height_ + t.y) * width_ + t.x;
    }
    [[nodiscard]] TexelPosition position(std::int64_t index) const {
        const std::int64_t row = index / width_;
        return {static_cast<int>(row / height_), static_cast<int>(index % width_),
                static_cast<int>(row % height_)};
    }

    /// Right, left, below, above.
    [[nodiscard]] std::array<std::int64_t, 4> around(std::int64_t centre) const {
        const TexelPosition t = position(centre);
        return {step(t, 1, 0), step(t, -1, 0), step(t, 0, 1), step(t, 0, -1)};
    }

  private:
    [[nodiscard]] std::int64_t step(const TexelPosition& t, int dx, int dy) const {
        const FacePoint<double> point{t.face, (t.x + dx + 0.5) / width_,
                                      (t.y + dy + 0.5) / height_};
        const FacePoint<double> p =
            visit(projection_, [&](auto proj) { return decltype(proj)::wrap(point); });
        return index({p.face, std::clamp(int(p.s * width_), 0, width_ - 1),
                      std::clamp(int(p.t * height_), 0, height_ - 1)});
    }

    Projection projection_;
    int width_, height_;
};

// Grows the valid texels into the holes, one ring a turn. Each turn's means are taken before any of
// them is written, so that no order of texels matters; each hole texel is visited a few times,
// however large the hole.
class HoleFiller {
  public:
    HoleFiller(Level& level, Projection projection)
        : level_(level),
          neighbours_(projection, level),
          states_(level.faces.size() * level.faces.front().texel_count(), State::valid) {
        const int width = level.width(), height = level.height();
        const std::vector<double> used = has_unused_texels(projection)
                                             ? solid_angle_table(projection, width, height)
                                             : std::vector<double>();
        for (std::int64_t i = 0; i < std::int64_t(states_.size()); ++i) {
            const TexelPosition t = neighbours_.position(i);
            if (!used.empty() && used[std::int64_t{t.y} * width + t.x] == 0) {
                states_[i] = State::unused;
            } else if (!is_finite(colour(i))) {
                states_[i] = State::hole;
                holes_.push_back(i);
            }
        }
    }

    std::int64_t fill() {
        std::int64_t filled_count = 0;
        // Across an edge a texel may have a neighbour that has not it for its own, and be missed by
        // the rings; then the rings start anew from what is left.
        for (std::vector<std::int64_t> ring = holes_; !ring.empty(); ring = remaining_holes()) {
            std::int64_t filled_now = 0;
            while (!ring.empty()) {
                ring = fill_ring(ring, filled_now);
            }
            if (filled_now == 0) break;
            filled_count += filled_now;
        }
        return filled_count;
    }

  private:
    enum class State : unsigned char { valid, hole, unused };

    [[nodiscard]] Vec3f colour(std::int64_t i) const {
        const TexelPosition t = neighbours_.position(i);
        return level_.faces[t.face].rgb(t.x, t.y);
    }

    // Fills those of `ring` that have a valid neighbour; returns the holes next to them.
    std::vector<std::int64_t> fill_ring(const std::vector<std::int64_t>& ring,
                                        std::int64_t& filled_count) {
        std::vector<std::pair<std::int64_t, Vec3f>> filled;
        for (const std::int64_t i : ring) {
            Vec3d sum(0, 0, 0);
            int count = 0;
            for (const std::int64_t neighbour : neighbours_.around(i)) {
                if (states_[neighbour] != State::valid) continue;
                sum += Vec3d(colour(neighbour));
                ++count;
            }
            if (count > 0) filled.emplace_back(i, Vec3f(sum / count));
        }
        for (const auto& [i, value] : filled) {
            const TexelPosition t = neighbours_.position(i);
            level_.faces[t.face].set_rgb(t.x, t.y, value);
            states_[i] = State::valid;
        }
        filled_count += std::int64_t(filled.size());

        std::vector<std::int64_t> next;
        for (const auto& [i, value] : filled) {
            for (const std::int64_t neighbour : neighbours_.around(i)) {
                if (states_[neighbour] == State::hole) next.push_back(neighbour);
            }
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        return next;
    }

    [[nodiscard]] std::vector<std::int64_t> remaining_holes() const {
        std::vector<std::int64_t> left;
        std::copy_if(holes_.begin(), holes_.end(), std::back_inserter(left),
                     [this](std::int64_t i) { return states_[i] == State::hole; });
        return left;
    }

    Level& level_;
    Neighbourhood neighbours_;
    std::vector<State> states_;
    std::vector<std::int64_t> holes_;
};

}  // namespace

TexelFaults find_faults(const Level& level, Projection projection) {
    const int height = level.height();
    std::vector<TexelFaults> rows(level.faces.size() * height);
    parallel_for(std::int64_t(rows.size()), [&](std::int64_t i) {
        rows[i] = row_faults(level, projection, int(i / height), int(i % height));
    });

    TexelFaults sum;
    for (const TexelFaults& row : rows) {
        if (sum.non_finite_count == 0) sum.first_non_finite = row.first_non_finite;
        sum.non_finite_count += row.non_finite_count;
        sum.negative_count += row.negative_count;
        sum.smallest = std::min(sum.smallest, row.smallest);
    }
    return sum;
}

std::int64_t repair(Level& level, Projection projection) {
    return HoleFiller(level, projection).fill();
}

void clear_unused_faults(Level& level, Projection projection) {
    if (!has_unused_texels(projection)) return;
    for (Image& image : level.faces) {
        for (int y = 0; y < image.height(); ++y) {
            for (int x = 0; x < image.width(); ++x) {
                if (!is_finite(image.rgb(x, y)) &&
                    texel_solid_angle(projection, image.width(), image.height(), x, y) == 0) {
                    image.set_rgb(x, y, Vec3f(0, 0, 0));
                }
            }
        }
    }
}

}  // namespace mirrorball::detail
