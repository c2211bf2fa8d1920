#include "prefilter/near_kernel.h"

#include <algorithm>
#include <cmath>

#include "core/bits.h"

namespace mirrorball::detail {
namespace {

constexpr int kMantissaBits = 23;

std::uint32_t bits_of(double value) {
    return bit_cast<std::uint32_t>(static_cast<float>(value));
}

}  // namespace

void NearKernel::add_part(double nearest, double farthest, double offset, int bits,
                          const std::function<std::vector<double>(std::span<const double>)>& f) {
    NearPart part;
    part.shift = kMantissaBits - bits;
    const std::uint32_t step = std::uint32_t{1} << part.shift;
    part.offset = bit_cast<float>(bits_of(offset) & ~(step - 1));  // an entry at the axis
    // from the entry at or before the start to the one at or after the end
    part.first = bits_of(nearest * nearest + part.offset) & ~(step - 1);
    const std::uint32_t last =
        (bits_of(farthest * farthest + part.offset) + step - 1) & ~(step - 1);
    std::vector<double> chords2;
    for (std::uint32_t at = part.first; at <= last; at += step)
        chords2.push_back(std::clamp(double{bit_cast<float>(at)} - double{part.offset}, 0.0, 4.0));
    part.nearest = static_cast<float>(std::sqrt(chords2.front()));
    part.farthest = static_cast<float>(std::sqrt(chords2.back()));
    for (const double value : f(chords2)) part.entries.push_back(static_cast<float>(value));
    // the last step falls to nothing: beyond it a reader finds the first of the zeros twice
    part.entries.insert(part.entries.end(), {0.0f, 0.0f});
    parts_.push_back(std::move(part));
}

float NearKernel::operator()(float chord2) const {
    float sum = 0;
    for (const NearPart& part : parts_) {
        const std::uint32_t place = bit_cast<std::uint32_t>(chord2 + part.offset) - part.first;
        const std::uint32_t index = std::min<std::uint32_t>(
            place >> part.shift, static_cast<std::uint32_t>(part.entries.size()) - 2);
        const std::uint32_t mask = (std::uint32_t{1} << part.shift) - 1;
        const float between =
            static_cast<float>(place & mask) * std::exp2(static_cast<float>(-part.shift));
        sum += part.entries[index] + between * (part.entries[index + 1] - part.entries[index]);
    }
    return sum;
}

}  // namespace mirrorball::detail
