// The inner loops of resampling: boxes to stencils, and stencils to colours. Compiled for every
// vector width that the processor may have.
#pragma once

#include "resample/stencil.h"

namespace mirrorball::detail {

/// The texels of a level, read as if carried by `moves`.
struct MovedLevel {
    const float* faces[kMostFaces] = {};
    int width = 0, height = 0;
    Moves moves;
};

void make_stencils(const Box* boxes, int count, int width, int height, Stencil* out);

/// Writes three floats for each of `count` stencils, the last first if `reversed`, and one float
/// more behind them. What reaches over a face's edges is left out: its indices go to `across`, and
/// how many they are is returned.
int weigh(const Stencil* stencils, int count, bool reversed, const MovedLevel& level, float* out,
          int* across);

}  // namespace mirrorball::detail
