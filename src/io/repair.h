// Texels that cannot be light: those that are no number, and negative ones.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <mirrorball/environment_map.h>

namespace mirrorball::detail {

struct TexelPosition {
    int face, x, y;
};

/// What is odd about the used texels of a level. Texels with any such channel are counted.
struct TexelFaults {
    std::int64_t non_finite_count = 0;
    TexelPosition first_non_finite{0, 0, 0};  ///< in the order of faces, then rows
    std::int64_t negative_count = 0;
    float smallest = 0;  ///< of the negative values

    /// Those of texels that come after.
    void add(const TexelFaults& later);
};
/// Of one row of a face of `height` rows. \pre three channels
[[nodiscard]] TexelFaults faults_in_row(std::span<const float> row, Projection projection,
                                        int height, int face, int y);
[[nodiscard]] TexelFaults find_faults(const Level& level, Projection projection);

/// Replaces used texels that are no number by the mean of their neighbours on the sphere, from the
/// rim of each hole inwards, ring by ring.
/// \pre     every face has three channels
/// \return  how many used texels were replaced; none are if every used texel is no number
std::int64_t repair(Level& level, Projection projection);

// What is told of them.
[[nodiscard]] std::string non_finite_in_words(Projection projection, int level,
                                              const TexelFaults& faults);
[[nodiscard]] std::string repaired_in_words(Projection projection, int level,
                                            const TexelFaults& faults);
[[nodiscard]] std::string beyond_repair_in_words(Projection projection, int level,
                                                 const TexelFaults& faults);
[[nodiscard]] std::string negative_in_words(int level, const TexelFaults& faults);
inline constexpr const char* kAlphaDropped =
    "its alpha channel, which is not 1 everywhere, was dropped";

/// Sets unused texels that are no number to 0.
void clear_unused_faults(Level& level, Projection projection);

}  // namespace mirrorball::detail
