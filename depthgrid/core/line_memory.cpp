#include "depthgrid/core/line_memory.hpp"

#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace depthgrid {
namespace {

constexpr std::align_val_t kLine{64};
constexpr std::size_t kLargePage = std::size_t{1} << 21;
constexpr std::size_t kLarge = kLargePage / 2;

}  // namespace

void* allocate_lines(std::size_t bytes) {
  if (bytes < kLarge) {
    return ::operator new(bytes, kLine);
  }
  const std::size_t whole = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  void* const memory = ::operator new (whole, std::align_val_t{kLargePage});
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  // A wish: without it pages are small, and nothing else changes.
  static_cast<void>(madvise(memory, whole, MADV_HUGEPAGE));
#endif
  return memory;
}

void free_lines(void* memory, std::size_t bytes) noexcept {
  ::operator delete (memory, bytes < kLarge ? kLine : std::align_val_t{kLargePage});
}

}  // namespace depthgrid
