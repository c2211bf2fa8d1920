// Pixels: a rectangle of float32 channels, top row first, channels interleaved, rows contiguous.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include <mirrorball/vector.h>
#include <mirrorball/zeroed_floats.h>

namespace mirrorball {

/// Sizes are texels. An image of 0 x 0 is empty. Values are scene-linear and unclamped; what they
/// mean (radiance, colour, height) is the owner's to know.
class Image {
  public:
    Image() = default;

    /// All zero. \pre width, height >= 1; 1 <= channels <= 4
    Image(int width, int height, int channels)
        : width_(width),
          height_(height),
          channels_(channels),
          values_(static_cast<std::size_t>(width) * height * channels + kPadding) {
        assert(width >= 1 && height >= 1 && channels >= 1 && channels <= 4);
    }

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int channels() const { return channels_; }
    [[nodiscard]] bool empty() const { return width_ == 0; }
    [[nodiscard]] std::int64_t texel_count() const { return std::int64_t{width_} * height_; }

    [[nodiscard]] std::span<float> values() { return {values_.data(), value_count()}; }
    [[nodiscard]] std::span<const float> values() const { return {values_.data(), value_count()}; }

    [[nodiscard]] std::span<float> row(int y) { return {at(0, y), row_size()}; }
    [[nodiscard]] std::span<const float> row(int y) const { return {at(0, y), row_size()}; }

    /// The first channel of a texel; the others follow it.
    [[nodiscard]] float* at(int x, int y) { return values_.data() + offset(x, y); }
    [[nodiscard]] const float* at(int x, int y) const { return values_.data() + offset(x, y); }

    /// \pre channels() >= 3
    [[nodiscard]] Vec3f rgb(int x, int y) const {
        const float* texel = at(x, y);
        return {texel[0], texel[1], texel[2]};
    }
    void set_rgb(int x, int y, const Vec3f& colour) {
        float* texel = at(x, y);
        texel[0] = colour.x, texel[1] = colour.y, texel[2] = colour.z;
    }

  private:
    // So that any texel, the last one too, can be read as four floats at once.
    static constexpr std::size_t kPadding = 3;

    [[nodiscard]] std::size_t value_count() const {
        return static_cast<std::size_t>(height_) * row_size();
    }
    [[nodiscard]] std::size_t row_size() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
    }
    [[nodiscard]] std::size_t offset(int x, int y) const {
        assert(x >= 0 && x < width_ && y >= 0 && y < height_);
        return (static_cast<std::size_t>(y) * width_ + x) * channels_;
    }

    int width_ = 0, height_ = 0, channels_ = 0;
    ZeroedFloats values_;
};

}  // namespace mirrorball
