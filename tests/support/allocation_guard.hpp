// Counts the heap allocations of the calling thread, for tests that forbid them.
//
//   const test::AllocationGuard guard;
//   evaluator.evaluate(points, answers);
//   EXPECT_EQ(guard.allocations(), 0);
//
// Linking a test that uses this replaces malloc and its relatives in that program, so operator new, std::malloc and
// what libraries allocate are all seen. Begin such a test with DEPTHGRID_REQUIRE_ALLOCATION_COUNT().
#pragma once

#include <cstdint>

namespace depthgrid::test {

class AllocationGuard {
 public:
  AllocationGuard() noexcept;

  /// Allocations by this thread since construction: calls of malloc, calloc, realloc, memalign and the like.
  [[nodiscard]] std::int64_t allocations() const noexcept;

  /// False where allocations cannot be counted: under a sanitizer that brings its own allocator, or without glibc.
  [[nodiscard]] static bool available() noexcept;

 private:
  std::int64_t at_start_;
};

}  // namespace depthgrid::test

/// Skips the test where allocations cannot be counted.
#define DEPTHGRID_REQUIRE_ALLOCATION_COUNT()                                                                     \
  if (!depthgrid::test::AllocationGuard::available()) {                                                          \
    GTEST_SKIP() << "allocations are not counted in this build: a sanitizer brings its own allocator, or the C " \
                    "library is not glibc";                                                                      \
  }                                                                                                              \
  static_assert(true)
