#include "repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "all_within.h"
#include "core/parallel.h"
#include "face_words.h"
#include "texel_use.h"

namespace mirrorball::detail {
namespace {

bool is_finite(const Vec3f& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// "1 texel is", "5 texels are".
std::string texels_in_words(std::int64_t count, std::string_view one, std::string_view more) {
    return fmt::format("{} texel{}", count, count == 1 ? one : more);
}

std::string found_in_words(Projection projection, int level, const TexelFaults& faults) {
    const auto [face, x, y] = faults.first_non_finite;
    return fmt::format("{} no number (NaN or infinite), the first {}",
                       texels_in_words(faults.non_finite_count, " is", "s are"),
                       texel_in_words(projection, level, face, x, y));
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

void TexelFaults::add(const TexelFaults& later) {
    if (non_finite_count == 0) first_non_finite = later.first_non_finite;
    non_finite_count += later.non_finite_count;
    negative_count += later.negative_count;
    smallest = std::min(smallest, later.smallest);
}

TexelFaults faults_in_row(std::span<const float> row, Projection projection, int height, int face,
                          int y) {
    TexelFaults faults;
    // most rows are well
    if (all_within(row, 0, std::numeric_limits<float>::max())) return faults;
    const int width = static_cast<int>(row.size() / 3);
    for (int x = 0; x < width; ++x) {
        const float* texel = &row[std::size_t{3} * x];
        const Vec3f c(texel[0], texel[1], texel[2]);
        const float least = std::min({c.x, c.y, c.z});
        const bool finite = is_finite(c);
        if (finite && least >= 0) continue;
        if (texel_solid_angle(projection, width, height, x, y) == 0) continue;
        if (!finite) {
            if (faults.non_finite_count++ == 0) faults.first_non_finite = {face, x, y};
        } else {
            ++faults.negative_count;
            faults.smallest = std::min(faults.smallest, least);
        }
    }
    return faults;
}

std::string non_finite_in_words(Projection projection, int level, const TexelFaults& faults) {
    return found_in_words(projection, level, faults) +
           "; --repair replaces them by their neighbours";
}

std::string repaired_in_words(Projection projection, int level, const TexelFaults& faults) {
    return found_in_words(projection, level, faults) + "; replaced by the mean of the neighbours";
}

std::string beyond_repair_in_words(Projection projection, int level, const TexelFaults& faults) {
    return found_in_words(projection, level, faults) + "; there is no good one to replace them by";
}

std::string negative_in_words(int level, const TexelFaults& faults) {
    return fmt::format("{} negative, down to {}{}; kept",
                       texels_in_words(faults.negative_count, " is", "s are"), faults.smallest,
                       level > 0 ? fmt::format(", in level {}", level) : std::string());
}

TexelFaults find_faults(const Level& level, Projection projection) {
    const int height = level.height();
    std::vector<TexelFaults> rows(level.faces.size() * height);
    parallel_for(std::int64_t(rows.size()), [&](std::int64_t i) {
        const int face = int(i / height), y = int(i % height);
        rows[i] = faults_in_row(level.faces[face].row(y), projection, height, face, y);
    });

    TexelFaults sum;
    for (const TexelFaults& row : rows) sum.add(row);
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
