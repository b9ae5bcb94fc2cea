// The open cubes of a best-first search, in buckets of distance: push and pop take constant time and never allocate.
// Internal.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace depthgrid::search {

struct VerdictNode;

/// Child `lane` of a node.
struct OpenCube {
  VerdictNode* node;
  float distance_m;  ///< from the axis: no point of the cube is nearer
  std::uint32_t lane;
};

/// Cubes come out by bucket, nearest bucket first; within a bucket last in, first out.
class Frontier {
 public:
  static constexpr int kBuckets = 512;

  explicit Frontier(std::size_t capacity) : slots_(capacity), next_(capacity) {}

  /// Empties it. Distances from 0 to largest_m are spread over the buckets.
  void reset(float largest_m) noexcept {
    heads_.fill(-1);
    occupied_.fill(0);
    used_ = 0;
    free_ = -1;
    current_ = 0;
    scale_ = static_cast<float>(kBuckets) / std::max(largest_m, 1e-6F) * 0.9999F;
  }

  /// False when there is no room.
  [[nodiscard]] bool push(const OpenCube& cube) noexcept {
    std::int32_t slot = free_;
    if (slot >= 0) {
      free_ = next_[static_cast<std::size_t>(slot)];
    } else if (used_ < slots_.size()) {
      slot = static_cast<std::int32_t>(used_++);
    } else {
      return false;
    }
    // Never behind the current bucket: a child may round to a hair less than its parent.
    const int bucket = std::clamp(static_cast<int>(cube.distance_m * scale_), current_, kBuckets - 1);
    slots_[static_cast<std::size_t>(slot)] = cube;
    next_[static_cast<std::size_t>(slot)] = heads_[static_cast<std::size_t>(bucket)];
    heads_[static_cast<std::size_t>(bucket)] = slot;
    occupied_[static_cast<std::size_t>(bucket) / 64] |= std::uint64_t{1} << (bucket % 64);
    return true;
  }

  /// Takes a cube of the nearest bucket; false when there is none.
  [[nodiscard]] bool pop(OpenCube& cube) noexcept {
    for (std::size_t word = static_cast<std::size_t>(current_) / 64; word < occupied_.size(); ++word) {
      if (occupied_[word] == 0) {
        continue;
      }
      current_ = static_cast<int>(word) * 64 + std::countr_zero(occupied_[word]);
      const auto bucket = static_cast<std::size_t>(current_);
      const std::int32_t slot = heads_[bucket];
      cube = slots_[static_cast<std::size_t>(slot)];
      heads_[bucket] = next_[static_cast<std::size_t>(slot)];
      if (heads_[bucket] < 0) {
        occupied_[word] &= occupied_[word] - 1;
      }
      next_[static_cast<std::size_t>(slot)] = free_;
      free_ = slot;
      return true;
    }
    return false;
  }

  /// Nothing open is nearer than this.
  [[nodiscard]] float lower_bound_m() const noexcept { return static_cast<float>(current_) / scale_ * 0.9999F; }

 private:
  std::vector<OpenCube> slots_;
  std::vector<std::int32_t> next_;
  std::array<std::int32_t, kBuckets> heads_{};
  std::array<std::uint64_t, kBuckets / 64> occupied_{};
  std::size_t used_ = 0;
  std::int32_t free_ = -1;
  int current_ = 0;
  float scale_ = 1;
};

}  // namespace depthgrid::search
