#include "depthgrid/search/recent_leaves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::search {

void RecentLeaves::add(const Cube& leaf) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (leaves_[i].x == leaf.x && leaves_[i].y == leaf.y && leaves_[i].z == leaf.z) {
      return;
    }
  }
  leaves_[next_] = leaf;
  next_ = (next_ + 1) % kCount;
  count_ = std::min(count_ + 1, kCount);
}

const Cube& RecentLeaves::nearest_to(const Axis& axis, float& distance_m) const noexcept {
  std::size_t best = 0;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < count_; ++i) {
    float x = leaves_[i].x - axis.a[0];
    float y = leaves_[i].y - axis.a[1];
    float z = leaves_[i].z - axis.a[2];
    const float product = (x * axis.along[0] + y * axis.along[1] + z * axis.along[2]) * axis.inverse_square;
    const float t = std::clamp(product, 0.0F, 1.0F);
    x -= t * axis.along[0];
    y -= t * axis.along[1];
    z -= t * axis.along[2];
    const float square = x * x + y * y + z * z;
    if (square < least) {
      least = square;
      best = i;
    }
  }
  distance_m = std::sqrt(least);
  return leaves_[best];
}

}  // namespace depthgrid::search
