// A function of the chord between two directions that is zero but on one or two intervals, as
// tables read sixteen at a time.
//
// The tables run in v = s^2 + offset, s the chord, and have a fixed number of steps from each power
// of two to the next: the bits of v as a float, but for the last few, are the index, and those last
// few the place between two entries. So steps are as fine at a peak (of about the square root of
// `offset` wide) as the peak needs, and grow with the distance from it; and s^2 = 2, the horizon,
// where clamped lobes have their crease, is an entry.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace mirrorball::detail {

struct NearPart {
    float nearest = 0, farthest = 0;  // the chords between which it is not zero
    float offset = 0;
    std::uint32_t first = 0;     // the bits of v at the first entry
    int shift = 0;               // bits between an entry and the next
    std::vector<float> entries;  // ends in two zeros, for all that is out of range
};

class NearKernel {
  public:
    NearKernel() = default;

    /// Adds f(v - offset) between chords. \pre 0 <= nearest < farthest <= 2; 1 <= bits <= 16
    /// @param f     from squared chords to values
    /// @param bits  log2 of the steps from a power of two to the next
    void add_part(double nearest, double farthest, double offset, int bits,
                  const std::function<std::vector<double>(std::span<const double>)>& f);

    [[nodiscard]] std::span<const NearPart> parts() const { return parts_; }

    /// The value at a squared chord, as the vectorised readers have it.
    [[nodiscard]] float operator()(float chord2) const;

    /// Does a ball of chords [nearest, farthest] touch where it is not zero?
    [[nodiscard]] bool reaches(float nearest, float farthest) const {
        for (const NearPart& part : parts_)
            if (nearest <= part.farthest && farthest >= part.nearest) return true;
        return false;
    }

  private:
    std::vector<NearPart> parts_;
};

}  // namespace mirrorball::detail
