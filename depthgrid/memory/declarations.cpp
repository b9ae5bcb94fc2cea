#include "depthgrid/memory/declarations.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::memory {
namespace {

/// Every voxel whose centre is within radius_m of the capsule's axis.
template <class Use>
void for_centres_within(const VoxelSet& voxels, const Capsule& capsule, double radius_m, Use&& use) noexcept {
  if (!(radius_m >= 0)) {
    return;
  }
  std::array<int, 3> first{};
  std::array<int, 3> last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double end = voxels.voxels()[axis];
    const double low = std::min(capsule.a[a], capsule.b[a]) - radius_m - voxels.low_world()[a];
    const double high = std::max(capsule.a[a], capsule.b[a]) + radius_m - voxels.low_world()[a];
    first[axis] = static_cast<int>(std::clamp(std::floor(low / voxels.voxel_m()), 0.0, end));
    last[axis] = static_cast<int>(std::clamp(std::floor(high / voxels.voxel_m()), -1.0, end - 1));
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) {
        if (distance_to_axis(capsule, voxels.centre_world(x, y, z)) <= radius_m) {
          use(x, y, z);
        }
      }
    }
  }
}

}  // namespace

void take_out(std::span<const Capsule> capsules, double distance_m, double thinnest_hidden_m,
              PossibleSpace& space) noexcept {
  VoxelSet& voxels = space.voxels;
  const double less_m = kVoxelHalfDiagonal * voxels.voxel_m() + space.pending_m - 0.5 * thinnest_hidden_m;
  for (const Capsule& capsule : capsules) {
    for_centres_within(voxels, capsule, capsule.radius_m + distance_m - less_m, [&](int x, int y, int z) {
      voxels.reset(x, y, z);
      space.is_everything = false;
    });
  }
}

void put_in(std::span<const Capsule> capsules, double distance_m, PossibleSpace& space) noexcept {
  VoxelSet& voxels = space.voxels;
  for (const Capsule& capsule : capsules) {
    for_centres_within(voxels, capsule, capsule.radius_m + distance_m + kVoxelHalfDiagonal * voxels.voxel_m() + 1e-9,
                       [&](int x, int y, int z) { voxels.set(x, y, z); });
  }
}

}  // namespace depthgrid::memory
