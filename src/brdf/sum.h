// Weighted sums of BRDFs.
#pragma once

#include <vector>

#include "brdf/model.h"

namespace mirrorball::detail {

struct SumTerm {
    Vec3d weight;
    ModelPointer model;
};

/// The model as terms of a sum: its own, or itself.
[[nodiscard]] std::vector<SumTerm> terms_of(const ModelPointer& model);
/// \throws Error(Errc::usage) if a weight is out of its range
[[nodiscard]] ModelPointer make_sum(std::vector<SumTerm> terms);

}  // namespace mirrorball::detail
