#include <mirrorball/zeroed_floats.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace mirrorball {
namespace {

#if defined(__linux__)

constexpr std::size_t kHugePage = std::size_t{2} << 20;

// Below this the allocator's own memory does, which is used again without asking the system.
constexpr std::size_t kLarge = 2 * kHugePage;

// Straight from the system, aligned to huge pages: a page fault for every 2 MiB, not for 4 KiB.
float* get_pages(std::size_t size) {
    const std::size_t reserved = size + kHugePage;
    void* const memory =
        mmap(nullptr, reserved, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    // what lies outside the aligned part goes back
    const auto begin = reinterpret_cast<std::uintptr_t>(memory);
    const std::size_t before = (kHugePage - begin % kHugePage) % kHugePage;
    char* const aligned = static_cast<char*>(memory) + before;
    if (before > 0) munmap(memory, before);
    if (before < kHugePage) munmap(aligned + size, kHugePage - before);
    madvise(aligned, size, MADV_HUGEPAGE);
    return reinterpret_cast<float*>(aligned);
}

std::size_t page_size_of(std::size_t count) {
    constexpr std::size_t page = 65536;  // a multiple of any system's
    return (count * sizeof(float) + page - 1) / page * page;
}

float* allocate(std::size_t count) {
    if (count > PTRDIFF_MAX / sizeof(float) - kHugePage) throw std::bad_alloc();
    const std::size_t size = page_size_of(count);
    if (size >= kLarge) return get_pages(size);
    void* const memory = std::calloc(count, sizeof(float));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<float*>(memory);
}

void release(float* values, std::size_t count) {
    const std::size_t size = page_size_of(count);
    if (size >= kLarge)
        munmap(values, size);
    else
        std::free(values);
}

#else

float* allocate(std::size_t count) {
    void* const memory = std::calloc(count, sizeof(float));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<float*>(memory);
}

void release(float* values, std::size_t /*count*/) {
    std::free(values);
}

#endif

}  // namespace

ZeroedFloats::ZeroedFloats(std::size_t count) : values_(allocate(count)), count_(count) {}

ZeroedFloats::ZeroedFloats(const ZeroedFloats& other) {
    if (other.count_ == 0) return;
    ZeroedFloats copy(other.count_);
    std::memcpy(copy.values_, other.values_, other.count_ * sizeof(float));
    swap(copy);
}

ZeroedFloats::~ZeroedFloats() {
    if (values_ != nullptr) release(values_, count_);
}

}  // namespace mirrorball
