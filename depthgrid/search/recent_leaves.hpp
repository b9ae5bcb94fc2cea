// Leaves that were the nearest obstacle of some capsule lately. Internal.
#pragma once

#include <array>
#include <cstddef>

#include "depthgrid/search/near_children.hpp"

namespace depthgrid::search {

/// The last few different ones.
class RecentLeaves {
 public:
  void add(const Cube& leaf) noexcept;
  void clear() noexcept { count_ = next_ = 0; }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  /// The one whose centre is nearest to the axis, and that distance, roughly. Not of an empty list.
  [[nodiscard]] const Cube& nearest_to(const Axis& axis, float& distance_m) const noexcept;

 private:
  static constexpr std::size_t kCount = 32;
  std::array<Cube, kCount> leaves_{};
  std::size_t count_ = 0;
  std::size_t next_ = 0;
};

}  // namespace depthgrid::search
