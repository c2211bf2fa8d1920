// The inner loops of resampling: boxes to stencils, and stencils to colours. Compiled for every
// vector width that the processor may have.
#pragma once

#include "resample/stencil.h"

namespace mirrorball::detail {

/// The texels of a level, read as if carried by `moves`.
struct MovedLevel {
    const float* faces[kMostFaces] = {};
    const float* slopes[kMostFaces] = {};  ///< of their columns, if known: see find_slopes()
    int width = 0, height = 0;
    Moves moves;
};

/// Appends the stencils of boxes of a face of that size while there is room, and writes to each the
/// number of its box to `owners`, where the stencil has its place. All in a block lie on one face.
/// How many boxes were done: one or more if the block was empty.
int append_stencils(const Box* boxes, int count, int width, int height, Stencils& out, int* owners);

/// Writes three floats for each stencil, the last first if `reversed`. Those of stencils that reach
/// over a face's edges mean nothing yet: the numbers of these go to `across`, and how many they are
/// is returned.
int weigh(const Stencils& stencils, bool reversed, const MovedLevel& level, float* out,
          int* across);

/// The slopes that monotone_cubic() takes along columns, at the texels of a row that has others
/// above and below. Where many stencils are smooth, they are found once and not for each.
void find_slopes(const float* row, int width, float* slopes);

}  // namespace mirrorball::detail
