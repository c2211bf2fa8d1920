// Texels lie in the vector's lanes, so that a light's terms are broadcast and each texel's sum
// grows by one light at a time, in the lights' order, whatever the width of a vector.
#include "prefilter/near_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prefilter/near_field.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef MIRRORBALL_NEAR_FIELD_ONCE
#define MIRRORBALL_NEAR_FIELD_ONCE
namespace mirrorball::detail {

constexpr std::size_t kMostAtOnce = 64;  // texels in the widest vector that may come

// A few lights against a few texels, whose number is a multiple of every vector's.
struct NearLights {
    const float *x, *y, *z, *r, *g, *b, *solid_angle;
};
struct NearTexels {
    const float *x, *y, *z;
    float *r, *g, *b, *weight;  // weight may be null
    std::size_t count;
};

}  // namespace mirrorball::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace mirrorball::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<float>;
using Vector = hn::Vec<Tag>;

// A part's table as vectors want it.
struct Reader {
    const float* entries;
    Vector offset, scale;
    hn::Vec<hn::RebindToUnsigned<Tag>> first, last, mask;
    int shift;

    explicit Reader(const NearPart& part) {
        const hn::RebindToUnsigned<Tag> bits;
        entries = part.entries.data();
        offset = hn::Set(Tag(), part.offset);
        scale = hn::Set(Tag(), 1.0f / static_cast<float>(1u << part.shift));
        first = hn::Set(bits, part.first);
        last = hn::Set(bits, static_cast<std::uint32_t>(part.entries.size()) - 2);
        mask = hn::Set(bits, (1u << part.shift) - 1);
        shift = part.shift;
    }

    HWY_INLINE Vector operator()(Vector chord2) const {
        const Tag tag;
        const hn::RebindToSigned<Tag> index_tag;
        const hn::RebindToUnsigned<Tag> bits;
        const auto place = hn::Sub(hn::BitCast(bits, hn::Add(chord2, offset)), first);
        const auto index = hn::BitCast(index_tag, hn::Min(hn::ShiftRightSame(place, shift), last));
        const Vector between =
            hn::Mul(hn::ConvertTo(tag, hn::BitCast(index_tag, hn::And(place, mask))), scale);
        const Vector left = hn::GatherIndex(tag, entries, index),
                     right = hn::GatherIndex(tag, entries + 1, index);
        return hn::MulAdd(between, hn::Sub(right, left), left);
    }
};

void AddLights(const NearPart& part, const NearLights& lights, std::size_t light_count,
               const NearTexels& texels) {
    const Tag tag;
    const Reader near(part);
    for (std::size_t i = 0; i < texels.count; i += hn::Lanes(tag)) {
        const Vector x = hn::LoadU(tag, texels.x + i), y = hn::LoadU(tag, texels.y + i),
                     z = hn::LoadU(tag, texels.z + i);
        Vector r = hn::LoadU(tag, texels.r + i), g = hn::LoadU(tag, texels.g + i),
               b = hn::LoadU(tag, texels.b + i);
        Vector weight = texels.weight ? hn::LoadU(tag, texels.weight + i) : hn::Zero(tag);
        for (std::size_t j = 0; j < light_count; ++j) {
            const Vector dx = hn::Sub(x, hn::Set(tag, lights.x[j])),
                         dy = hn::Sub(y, hn::Set(tag, lights.y[j])),
                         dz = hn::Sub(z, hn::Set(tag, lights.z[j]));
            const Vector k = near(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
            r = hn::MulAdd(k, hn::Set(tag, lights.r[j]), r);
            g = hn::MulAdd(k, hn::Set(tag, lights.g[j]), g);
            b = hn::MulAdd(k, hn::Set(tag, lights.b[j]), b);
            weight = hn::MulAdd(k, hn::Set(tag, lights.solid_angle[j]), weight);
        }
        hn::StoreU(r, tag, texels.r + i);
        hn::StoreU(g, tag, texels.g + i);
        hn::StoreU(b, tag, texels.b + i);
        if (texels.weight) hn::StoreU(weight, tag, texels.weight + i);
    }
}

}  // namespace mirrorball::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mirrorball::detail {
namespace {

HWY_EXPORT(AddLights);

constexpr std::size_t kFan = 8;

// Rounding of directions and of distances between them.
constexpr float kSlack = 1e-6f;

// Puts two zeros between any two of the low 21 bits.
std::uint64_t spread(std::uint64_t bits) {
    bits &= 0x1fffff;
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    bits = (bits | bits << 2) & 0x1249249249249249;
    return bits;
}

// Along a curve that keeps neighbours in space together.
std::uint64_t morton(const Vec3f& direction) {
    const auto cell = [](float x) {
        return static_cast<std::uint64_t>(std::clamp(x + 1, 0.0f, 2.0f) * 1048575);
    };
    return spread(cell(direction.x)) | spread(cell(direction.y)) << 1 |
           spread(cell(direction.z)) << 2;
}

std::vector<std::uint32_t> morton_order(std::span<const Light> lights) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i)
        keys[i] = {morton(lights[i].direction), static_cast<std::uint32_t>(i)};
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(lights.size());
    for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
    return order;
}

// About the middle of the box of `count` points, with a radius each.
template <class Ball, class Point>
Ball enclosing(std::size_t count, const Point& point) {
    Vec3f low = point(0).centre, high = low;
    for (std::size_t i = 1; i < count; ++i) {
        const Vec3f p = point(i).centre;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    Ball ball{(low + high) * 0.5f, 0};
    for (std::size_t i = 0; i < count; ++i)
        ball.radius =
            std::max(ball.radius, (point(i).centre - ball.centre).length() + point(i).radius);
    return ball;
}

}  // namespace

// One tile against the lights that reach it.
struct NearField::Walk {
    const NearKernel& near;
    Ball ball;  // of the tile
    NearTexels texels;

    // Is anything of a ball in reach of anything of the tile, by this part?
    [[nodiscard]] bool reaches(const NearPart& part, const Vec3f& centre, float radius) const {
        const float distance = (centre - ball.centre).length(),
                    spread = radius + ball.radius + kSlack;
        return distance - spread <= part.farthest && distance + spread >= part.nearest;
    }
};

NearField::NearField(std::span<const Light> lights) {
    for (const std::uint32_t i : morton_order(lights)) {
        const Light& light = lights[i];
        x_.push_back(light.direction.x);
        y_.push_back(light.direction.y);
        z_.push_back(light.direction.z);
        r_.push_back(light.power.x);
        g_.push_back(light.power.y);
        b_.push_back(light.power.z);
        solid_angle_.push_back(light.solid_angle);
    }
    if (lights.empty()) return;
    std::size_t below = lights.size();
    const auto child = [&](std::size_t i) {
        return levels_.empty() ? Ball{{x_[i], y_[i], z_[i]}, 0} : levels_.back()[i];
    };
    do {
        std::vector<Ball> balls;
        for (std::size_t start = 0; start < below; start += kFan)
            balls.push_back(enclosing<Ball>(std::min(kFan, below - start),
                                            [&](std::size_t i) { return child(start + i); }));
        below = balls.size();
        levels_.push_back(std::move(balls));
    } while (below > 1);
}

bool NearField::reached(const NearKernel& near, const Ball& ball, std::size_t level,
                        std::size_t index) const {
    const Ball& here = levels_[level][index];
    const float distance = (here.centre - ball.centre).length();
    const float spread = here.radius + ball.radius + kSlack;
    if (!near.reaches(std::max(distance - spread, 0.0f), distance + spread)) return false;
    if (level == 0) return true;
    const std::size_t end = std::min((index + 1) * kFan, levels_[level - 1].size());
    for (std::size_t i = index * kFan; i < end; ++i)
        if (reached(near, ball, level - 1, i)) return true;
    return false;
}

bool NearField::reaches(const NearKernel& near, const Vec3f& centre, float radius) const {
    return !levels_.empty() && reached(near, {centre, radius}, levels_.size() - 1, 0);
}

void NearField::visit(Walk& walk, std::size_t level, std::size_t index) const {
    const Ball& ball = levels_[level][index];
    const auto parts = walk.near.parts();
    const bool reached = std::any_of(parts.begin(), parts.end(), [&](const NearPart& part) {
        return walk.reaches(part, ball.centre, ball.radius);
    });
    if (!reached) return;
    const std::size_t start = index * kFan;
    if (level > 0) {
        const std::size_t end = std::min(start + kFan, levels_[level - 1].size());
        for (std::size_t i = start; i < end; ++i) visit(walk, level - 1, i);
        return;
    }
    const std::size_t end = std::min(start + kFan, x_.size());
    for (const NearPart& part : parts) {
        const auto in_reach = [&](std::size_t i) {
            return walk.reaches(part, {x_[i], y_[i], z_[i]}, 0);
        };
        for (std::size_t i = start; i < end; ++i) {
            if (!in_reach(i)) continue;
            std::size_t after = i + 1;
            while (after < end && in_reach(after)) ++after;
            const NearLights lights{&x_[i], &y_[i], &z_[i],          &r_[i],
                                    &g_[i], &b_[i], &solid_angle_[i]};
            HWY_DYNAMIC_DISPATCH(AddLights)(part, lights, after - i, walk.texels);
            i = after;
        }
    }
}

void NearField::add(const NearKernel& near, const NearTile& tile) const {
    if (levels_.empty() || near.parts().empty() || tile.x.empty()) return;
    const std::size_t count = tile.x.size();
    const auto texel = [&](std::size_t i) { return Ball{{tile.x[i], tile.y[i], tile.z[i]}, 0}; };
    // whole vectors work on the tile itself, what is left over on a copy that is filled up
    const std::size_t whole = count / kMostAtOnce * kMostAtOnce, rest = count - whole;
    const auto add_to = [&](std::size_t start, std::size_t texel_count, const NearTexels& texels) {
        Walk walk{near,
                  enclosing<Ball>(texel_count, [&](std::size_t i) { return texel(start + i); }),
                  texels};
        visit(walk, levels_.size() - 1, 0);
    };
    float* const weight = tile.weight.empty() ? nullptr : tile.weight.data();
    if (whole > 0)
        add_to(0, whole,
               {tile.x.data(), tile.y.data(), tile.z.data(), tile.r.data(), tile.g.data(),
                tile.b.data(), weight, whole});
    if (rest == 0) return;
    float copy[7][kMostAtOnce] = {};
    for (std::size_t i = 0; i < kMostAtOnce; ++i) {
        const std::size_t from = whole + std::min(i, rest - 1);
        copy[0][i] = tile.x[from];
        copy[1][i] = tile.y[from];
        copy[2][i] = tile.z[from];
    }
    add_to(whole, rest,
           {copy[0], copy[1], copy[2], copy[3], copy[4], copy[5], weight ? copy[6] : nullptr,
            kMostAtOnce});
    for (std::size_t i = 0; i < rest; ++i) {
        tile.r[whole + i] += copy[3][i];
        tile.g[whole + i] += copy[4][i];
        tile.b[whole + i] += copy[5][i];
        if (weight) weight[whole + i] += copy[6][i];
    }
}

}  // namespace mirrorball::detail
#endif
