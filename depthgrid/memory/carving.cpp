#include "depthgrid/memory/carving.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "depthgrid/core/rounding.hpp"
#include "depthgrid/views/ball_query.hpp"

namespace depthgrid::memory {
namespace {

/// Blocks that are looked at in one go.
constexpr std::size_t kChunk = 32;

class Carving {
 public:
  Carving(const Carver& carver, BlockingPixels& blocking, VoxelSet& voxels) noexcept
      : carver_(carver),
        blocking_(blocking),
        voxels_(voxels),
        corner_m_(voxels.low_world() - carver.origin_world),
        voxel_m_(voxels.voxel_m()) {}

  std::int64_t run() noexcept {
    const std::array<int, 3>& count = voxels_.blocks(0);
    std::size_t block = 0;
    for (int z = 0; z < count[2]; ++z) {
      for (int y = 0; y < count[1]; ++y) {
        for (int x = 0; x < count[0]; x += static_cast<int>(kChunk)) {
          const auto here = std::min(static_cast<std::size_t>(count[0] - x), kChunk);
          see_blocks(x, y, z, block, here);
          block += here;
        }
      }
    }
    if (removed_ > 0) {
      voxels_.rebuild();
    }
    return removed_;
  }

 private:
  void see_blocks(int x, int y, int z, std::size_t first, std::size_t count) noexcept {
    Block* const blocks = voxels_.voxel_blocks().data() + first;
    if (std::all_of(blocks, blocks + count, [](Block block) { return block == 0; })) {
      return;
    }
    const Eigen::Vector3d low_m = corner_m_ + 4 * voxel_m_ * Eigen::Vector3d(x, y, z);
    const Eigen::Vector3f middle = (low_m + Eigen::Vector3d::Constant(2 * voxel_m_)).cast<float>();
    std::array<Block, kChunk> open;  // NOLINT(*-member-init): written by see_row()
    removed_ += see_row(carver_, {middle.x(), middle.y(), middle.z(), static_cast<float>(voxel_m_), count, blocks,
                                  open.data(), blocking_.of_block(first)});
    for (std::size_t i = 0; i < count; ++i) {
      for (Block rest = open[i]; rest != 0; rest &= rest - 1) {
        const int bit = std::countr_zero(rest);
        const Eigen::Vector3d at(static_cast<double>(4 * i) + (bit & 3), (bit >> 2) & 3, bit >> 4);
        if (is_free(low_m + voxel_m_ * (at + Eigen::Vector3d::Constant(0.5)))) {
          blocks[i] &= ~(Block{1} << bit);
          ++removed_;
        }
      }
    }
  }

  /// The ball of a single voxel.
  [[nodiscard]] bool is_free(const Eigen::Vector3d& centre_m) const noexcept {
    const Eigen::Vector3d p = carver_.camera.to_camera(centre_m);
    return !views::meets_not_known_free(carver_.camera, views::Clip{}, p, carver_.radius_m(p));
  }

  const Carver& carver_;
  BlockingPixels& blocking_;
  VoxelSet& voxels_;
  Eigen::Vector3d corner_m_;
  double voxel_m_;
  std::int64_t removed_ = 0;
};

}  // namespace

double reach_around_centre_m(const PossibleSpace& space, double thinnest_hidden_m) noexcept {
  return std::max(0.0, kVoxelHalfDiagonal * space.voxels.voxel_m() + space.pending_m - 0.5 * thinnest_hidden_m);
}

Carver make_carver(const views::Snapshot& snapshot, std::size_t camera, double late_s, const DepthPlanes& planes,
                   const PossibleSpace& space, double thinnest_hidden_m) noexcept {
  const VoxelSet& voxels = space.voxels;
  const views::Settings& settings = snapshot.settings();
  const CameraMargins& margins = settings.margins[camera];
  Carver carver;
  carver.origin_world = 0.5 * (voxels.low_world() + voxels.high_world());
  const double extent_m = (voxels.high_world() - voxels.low_world()).norm();
  views::LocalCamera& local = carver.camera;
  make_local(snapshot, camera, carver.origin_world, extent_m, local);
  const double moves_s = margins.half_exposure_s + margins.time_uncertainty_s + late_s;
  local.pose_margin = {margins.translation_m, margins.rotation_rad,
                       settings.v_max_m_s > 0 ? motion_margin_m(margins, settings.v_max_m_s * moves_s) : 0.0};
  carver.planes = &planes;
  carver.reach_m = reach_around_centre_m(space, thinnest_hidden_m);
  // Centres of voxels are no short binary numbers, unlike those of the search: a few roundings more.
  local.guard_m *= 2;
  // The boxes of cubes are grown by the whole radius.
  const double at_camera_m = carver.radius_m(Eigen::Vector3d::Zero());
  carver.least_radius_m = float_below(at_camera_m);
  local.has_pose_error = true;
  local.pose_error_m = float_above(at_camera_m);
  local.pose_error_per_m = float_above(local.pose_margin.rotation_rad);
  return carver;
}

std::int64_t carve(const Carver& carver, BlockingPixels& blocking, VoxelSet& voxels) noexcept {
  return Carving(carver, blocking, voxels).run();
}

}  // namespace depthgrid::memory
