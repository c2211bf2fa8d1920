// Arrays that vector code can load and store whole.
#pragma once

#include <cassert>
#include <cstddef>

#include <hwy/aligned_allocator.h>

namespace mirrorball::detail {

/// A fixed number of values, aligned for any vector. They begin undefined: working memory is
/// written before it is read.
template <class T>
class AlignedArray {
  public:
    AlignedArray() = default;
    explicit AlignedArray(std::size_t count)
        : values_(hwy::AllocateAligned<T>(count > 0 ? count : 1)),
          count_(count) {
        if (!values_) throw std::bad_alloc();
    }

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] T* data() { return values_.get(); }
    [[nodiscard]] const T* data() const { return values_.get(); }
    T& operator[](std::size_t i) {
        assert(i < count_);
        return values_[i];
    }
    const T& operator[](std::size_t i) const {
        assert(i < count_);
        return values_[i];
    }
    T* begin() { return data(); }
    T* end() { return data() + count_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + count_; }

  private:
    hwy::AlignedFreeUniquePtr<T[]> values_;
    std::size_t count_ = 0;
};

}  // namespace mirrorball::detail
