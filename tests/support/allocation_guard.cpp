#include "support/allocation_guard.hpp"

#include <cerrno>
#include <cstdlib>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define DEPTHGRID_SANITIZER_ALLOCATES
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DEPTHGRID_SANITIZER_ALLOCATES
#endif
#if defined(__GLIBC__) && !defined(DEPTHGRID_SANITIZER_ALLOCATES)
#define DEPTHGRID_COUNTS_ALLOCATIONS
#endif

namespace {

// Constant-initialised and trivial, so that malloc may touch it before and after everything else lives.
thread_local std::int64_t allocations_of_this_thread = 0;

}  // namespace

#ifdef DEPTHGRID_COUNTS_ALLOCATIONS
// glibc lets a program define these functions and keeps its own under the names below. free() needs no twin.
extern "C" {
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* block, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;

void* malloc(std::size_t size) noexcept {
  ++allocations_of_this_thread;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  ++allocations_of_this_thread;
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  ++allocations_of_this_thread;
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++allocations_of_this_thread;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++allocations_of_this_thread;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  ++allocations_of_this_thread;
  void* const made = __libc_memalign(alignment, size);
  if (made == nullptr) {
    return ENOMEM;
  }
  *block = made;
  return 0;
}
}
#endif

namespace depthgrid::test {

AllocationGuard::AllocationGuard() noexcept : at_start_(allocations_of_this_thread) {}

std::int64_t AllocationGuard::allocations() const noexcept { return allocations_of_this_thread - at_start_; }

bool AllocationGuard::available() noexcept {
#ifdef DEPTHGRID_COUNTS_ALLOCATIONS
  return true;
#else
  return false;
#endif
}

}  // namespace depthgrid::test
