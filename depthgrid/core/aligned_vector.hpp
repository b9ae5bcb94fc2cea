// Vectors that begin at a cache line, for rows that are read and written a vector register at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "depthgrid/core/line_memory.hpp"

namespace depthgrid {

template <class Value>
struct CacheLineAllocator {
  using value_type = Value;

  CacheLineAllocator() = default;
  template <class Other>
  explicit(false) CacheLineAllocator(const CacheLineAllocator<Other>& /*other*/) noexcept {}

  [[nodiscard]] Value* allocate(std::size_t count) {
    return static_cast<Value*>(allocate_lines(count * sizeof(Value)));
  }
  void deallocate(Value* values, std::size_t count) noexcept { free_lines(values, count * sizeof(Value)); }
  friend bool operator==(const CacheLineAllocator& /*a*/, const CacheLineAllocator& /*b*/) noexcept { return true; }
};

template <class Value>
using AlignedVector = std::vector<Value, CacheLineAllocator<Value>>;

}  // namespace depthgrid
