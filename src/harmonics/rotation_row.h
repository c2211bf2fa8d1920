// What the vector code of rotation.cpp is given: one row of a Wigner matrix of a quarter turn.
#pragma once

#include <array>
#include <cstddef>

namespace mirrorball::detail {

/// Columns side by side. Row d adds to three sums, and leads to the next row.
struct RowSteps {
    const double* twice_m;
    const double* counts;         ///< 1, or 0 while a column is below the least double
    std::array<double*, 3> sums;  ///< += d times its value
    std::array<double, 3> values;
    double share, loss;  ///< next row = 2 m share d - loss (row before)
    std::size_t count;
};

}  // namespace mirrorball::detail
