#include "harmonics/fourier.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <mirrorball/vector.h>

namespace mirrorball::detail {
namespace {

FourierPlan::Complex root_of_unity(std::int64_t k, std::int64_t n) {
    const double angle = -2 * kPi * static_cast<double>(k % n) / static_cast<double>(n);
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

// Fours first: they do the work of two twos in one pass over memory.
std::vector<int> factors(int length) {
    std::vector<int> result;
    for (const int radix : {4, 2, 3, 5}) {
        for (; length % radix == 0; length /= radix) result.push_back(radix);
    }
    for (int prime = 7; length > 1; prime += 2) {
        if (prime * prime > length) prime = length;
        for (; length % prime == 0; length /= prime) result.push_back(prime);
    }
    return result;
}

}  // namespace

FourierPlan::FourierPlan(int length) : length_(length) {
    int left = length, stride = 1;
    for (const int radix : factors(length)) {
        Pass pass{radix, left, stride, static_cast<int>(numbers_.size()), 0};
        for (int p = 0; p < left / radix; ++p) {
            for (int k = 1; k < radix; ++k)
                numbers_.push_back(root_of_unity(std::int64_t{p} * k, left));
        }
        pass.roots = static_cast<int>(numbers_.size());
        for (int k = 0; k < radix; ++k) numbers_.push_back(root_of_unity(k, radix));
        passes_.push_back(pass);
        left /= radix, stride *= radix;
    }
}

int largest_prime_factor(int length) {
    if (length <= 1) return 1;
    const std::vector<int> all = factors(length);
    return *std::max_element(all.begin(), all.end());
}

int good_fourier_length(int least) {
    int length = (std::max(least, 4) + 3) / 4 * 4;
    while (largest_prime_factor(length) > 5) length += 4;
    return length;
}

}  // namespace mirrorball::detail
