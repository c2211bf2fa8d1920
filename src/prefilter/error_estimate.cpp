#include "prefilter/error_estimate.h"

#include <algorithm>
#include <cmath>

namespace mirrorball::detail {
namespace {

double square(double x) {
    return x * x;
}

}  // namespace

double relative_error(std::span<const double> spectrum, const ErrorTerms& terms) {
    double result = 0, error = 0;
    for (std::size_t l = 0; l < spectrum.size(); ++l) {
        const double far = l < terms.far.size() ? terms.far[l] : 0;
        const double wave = l < terms.waves.size() ? terms.waves[l] : 0;
        const double lambda = l < terms.lambda.size() ? terms.lambda[l] : 0;
        result += square(far) * spectrum[l];
        error += (square(lambda - far) + square(far * wave)) * spectrum[l];
    }
    // Degrees that were not analysed are taken to hold as much each as the last that were.
    const std::size_t count = spectrum.size(), tail = std::max<std::size_t>(1, count / 8);
    double power = 0, coefficients = 0;
    for (std::size_t l = count - tail; l < count; ++l) {
        power += spectrum[l];
        coefficients += 2 * static_cast<double>(l) + 1;
    }
    error += terms.beyond * power / coefficients;
    return result > 0 ? std::sqrt(error / result) : 0;
}

}  // namespace mirrorball::detail
