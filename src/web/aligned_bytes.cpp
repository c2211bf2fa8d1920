// Highway's two functions that are in its library and not in its headers.
#include <hwy/aligned_allocator.h>

#include <cstdlib>

namespace hwy {

void* AllocateAlignedBytes(std::size_t size, AllocPtr, void*) {
    const std::size_t whole = (size + HWY_ALIGNMENT - 1) / HWY_ALIGNMENT * HWY_ALIGNMENT;
    return whole < size ? nullptr : std::aligned_alloc(HWY_ALIGNMENT, whole);
}

void FreeAlignedBytes(const void* bytes, FreePtr, void*) {
    std::free(const_cast<void*>(bytes));
}

}  // namespace hwy
