// Memory of images: floats that begin as zero without being written.
#pragma once

#include <cstddef>
#include <utility>

namespace mirrorball {

/// A fixed number of floats, all zero at first. What is large comes from the system as zero pages,
/// in huge ones where it has them: nothing is touched before it is used, and whichever threads
/// write an image first share the cost of getting it.
class ZeroedFloats {
  public:
    ZeroedFloats() = default;
    /// \throws std::bad_alloc
    explicit ZeroedFloats(std::size_t count);
    ZeroedFloats(const ZeroedFloats& other);
    ZeroedFloats(ZeroedFloats&& other) noexcept { swap(other); }
    ZeroedFloats& operator=(ZeroedFloats other) noexcept {
        swap(other);
        return *this;
    }
    ~ZeroedFloats();

    [[nodiscard]] float* data() { return values_; }
    [[nodiscard]] const float* data() const { return values_; }

  private:
    void swap(ZeroedFloats& other) noexcept {
        std::swap(values_, other.values_);
        std::swap(count_, other.count_);
    }

    float* values_ = nullptr;
    std::size_t count_ = 0;
};

}  // namespace mirrorball
