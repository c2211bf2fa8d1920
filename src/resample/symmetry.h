// What of a target needs to be worked out, and what of it is the same again.
//
// A cube turned by a right angle is the same cube, and so is its mirror image; a panorama about the
// same axis is, too. Where such a symmetry carries the texels of the target to texels, and those of
// the source to texels, what one part of the target takes from the source is what another takes
// from the source so carried. A cube map of a panorama has 24 quarters of faces, of which two tell
// all.
#pragma once

#include <vector>

#include <mirrorball/axes.h>
#include <mirrorball/projection.h>

#include "resample/stencil.h"

namespace mirrorball::detail {

/// A part of the target that repeats a patch: its texels lie on `face`, mirrored as said, and take
/// from the source, moved, what the patch's texels take.
struct Repeat {
    int face;
    bool flip_x, flip_y;
    Moves source;
};

/// A rectangle of the target and all its repeats, the first of which is itself.
struct Patch {
    int face, x, y, width, height;
    std::vector<Repeat> repeats;
};

struct Grid {
    Projection projection;
    int width, height;
};

/// Patches whose repeats are all texels of the target, each once. `to_source` has the target's axes
/// as the source sees them.
std::vector<Patch> find_patches(const Grid& target, const Grid& source, const Axes& to_source);

}  // namespace mirrorball::detail
