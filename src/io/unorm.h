// Integers that stand for [0, 1]: 8- and 16-bit samples of PNG, TIFF and JPEG, sRGB or linear.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "../core/parallel.h"
#include "codec.h"

namespace mirrorball::detail {

/// Whether the last of so many channels is alpha, which is never under a transfer curve.
[[nodiscard]] inline bool has_alpha(int channels) {
    return channels == 2 || channels == 4;
}

/// Scene-linear values of all codes of T, for colour and for alpha.
template <class T>
class UnormDecoder {
  public:
    explicit UnormDecoder(Transfer transfer) : linear_(kCount), colour_(kCount) {
        for (std::size_t i = 0; i < kCount; ++i) {
            linear_[i] = static_cast<float>(static_cast<double>(i) / (kCount - 1));
            colour_[i] = transfer == Transfer::linear ? linear_[i] : srgb_to_linear(linear_[i]);
        }
    }
    [[nodiscard]] float value(T code, bool is_alpha) const {
        return (is_alpha ? linear_ : colour_)[code];
    }
    void decode(std::span<const T> codes, int channels, std::span<float> values) const {
        const int alpha = has_alpha(channels) ? channels - 1 : channels;
        int c = 0;
        for (std::size_t i = 0; i < codes.size(); ++i) {
            values[i] = value(codes[i], c == alpha);
            if (++c == channels) c = 0;
        }
    }

  private:
    static constexpr std::size_t kCount = std::size_t{std::numeric_limits<T>::max()} + 1;
    std::vector<float> linear_, colour_;
};

/// Values within [0, 1], rounded to the nearest code, after sRGB's curve unless `transfer` is
/// linear. \pre as many codes as values
template <class T>
void encode(std::span<const float> values, int channels, Transfer transfer, std::span<T> codes) {
    const int alpha = has_alpha(channels) ? channels - 1 : channels;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_linear =
            transfer == Transfer::linear || static_cast<int>(i % channels) == alpha;
        const double encoded = is_linear ? values[i] : linear_to_srgb(values[i]);
        codes[i] = static_cast<T>(encoded * std::numeric_limits<T>::max() + 0.5);
    }
}

/// Gives each row's codes, from the top, to row(codes). The curve takes longer than most encoders
/// do, so a band of rows is computed by all threads at a time.
template <class T, class F>
void encode_rows(const Image& image, Transfer transfer, const F& row) {
    constexpr int kBand = 64;
    const std::size_t row_size = image.row(0).size();
    std::vector<T> codes(kBand * row_size);
    for (int begin = 0; begin < image.height(); begin += kBand) {
        const int count = std::min(kBand, image.height() - begin);
        parallel_for(count, [&](std::int64_t i) {
            encode<T>(image.row(begin + static_cast<int>(i)), image.channels(), transfer,
                      std::span(codes).subspan(i * row_size, row_size));
        });
        for (int i = 0; i < count; ++i) row(std::span(codes).subspan(i * row_size, row_size));
    }
}

/// What a person should know of how integers were taken.
[[nodiscard]] inline std::string transfer_note(Transfer transfer, int bits) {
    return std::to_string(bits) + (transfer == Transfer::linear
                                       ? "-bit values taken as linear, as asked"
                                       : "-bit values decoded from sRGB to linear");
}

}  // namespace mirrorball::detail
