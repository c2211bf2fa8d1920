// Working memory that outlives its use.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "core/aligned.h"

namespace mirrorball::detail {

class ScratchPool;

/// Floats borrowed from a pool, which goes on to live as long as they do.
class ScratchArray {
  public:
    ScratchArray() = default;
    ScratchArray(std::shared_ptr<ScratchPool> pool, std::size_t count);
    ScratchArray(ScratchArray&&) = default;
    ScratchArray& operator=(ScratchArray&& other) noexcept {
        std::swap(pool_, other.pool_);
        std::swap(array_, other.array_);
        std::swap(count_, other.count_);
        return *this;
    }
    ~ScratchArray();

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] float* data() { return array_.data(); }
    [[nodiscard]] const float* data() const { return array_.data(); }
    [[nodiscard]] float* begin() { return data(); }
    [[nodiscard]] float* end() { return data() + count_; }

  private:
    std::shared_ptr<ScratchPool> pool_;
    AlignedArray<float> array_;
    std::size_t count_ = 0;
};

/// Arrays to borrow, undefined at first. What is given back is lent again: fresh memory costs a
/// fault per page, which for transforms is as much as the work. Holds what was out at the same
/// time.
class ScratchPool {
  public:
    /// The smallest there is that is large enough, or a new one.
    AlignedArray<float> take(std::size_t count) {
        {
            const std::lock_guard lock(mutex_);
            auto best = free_.end();
            for (auto i = free_.begin(); i != free_.end(); ++i) {
                if (i->size() >= count && (best == free_.end() || i->size() < best->size()))
                    best = i;
            }
            if (best != free_.end()) {
                AlignedArray<float> array = std::move(*best);
                free_.erase(best);
                return array;
            }
        }
        return AlignedArray<float>(count);
    }
    void give_back(AlignedArray<float> array) {
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(array));
    }

  private:
    std::mutex mutex_;
    std::vector<AlignedArray<float>> free_;
};

inline ScratchArray::ScratchArray(std::shared_ptr<ScratchPool> pool, std::size_t count)
    : pool_(std::move(pool)),
      array_(pool_->take(count)),
      count_(count) {}

inline ScratchArray::~ScratchArray() {
    if (pool_) pool_->give_back(std::move(array_));
}

}  // namespace mirrorball::detail
