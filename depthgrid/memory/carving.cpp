#include "depthgrid/memory/carving.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "depthgrid/core/rounding.hpp"
#include "depthgrid/views/ball_query.hpp"

namespace depthgrid::memory {
namespace {

constexpr Block kOctant = 0x00330033;  ///< 2 x 2 x 2 cells of a block

/// Where octant i of a block begins, and cell i of the first octant.
constexpr std::array<int, 8> kOctants{0, 2, 8, 10, 32, 34, 40, 42};
constexpr std::array<int, 8> kCells{0, 1, 4, 5, 16, 17, 20, 21};

/// Place of a block of some level.
struct At {
  int x, y, z;
};

class Carving {
 public:
  Carving(const Carver& carver, VoxelSet& voxels) noexcept
      : carver_(carver),
        voxels_(voxels),
        corner_m_(voxels.low_world() - carver.origin_world),
        voxel_m_(voxels.voxel_m()) {}

  std::int64_t run() noexcept {
    constexpr int kTop = VoxelSet::kLevels - 1;
    const std::array<int, 3>& count = voxels_.blocks(kTop);
    for (int z = 0; z < count[2]; ++z) {
      for (int y = 0; y < count[1]; ++y) {
        for (int x = 0; x < count[0]; ++x) {
          visit(kTop, {x, y, z});
        }
      }
    }
    return removed_;
  }

 private:
  /// Eight pieces of a cube with some of the set in them.
  [[nodiscard]] ChildrenSeen look(const Eigen::Vector3d& centre_m, int voxels_a_piece,
                                  std::uint32_t asked) const noexcept {
    const views::Cube parent{static_cast<float>(centre_m.x()), static_cast<float>(centre_m.y()),
                             static_cast<float>(centre_m.z()), 0};
    const double offset_m = 0.5 * voxels_a_piece * voxel_m_;
    const double half_m = 0.5 * (voxels_a_piece - 1) * voxel_m_;
    return look_at_children(carver_, parent, static_cast<float>(offset_m), half_m > 0 ? float_above(half_m) : 0.0F,
                            asked);
  }

  // NOLINTNEXTLINE(misc-no-recursion): as deep as the pyramid
  void visit(int level, const At& at) noexcept {
    Block& block = voxels_.block(level, at.x, at.y, at.z);
    if (block == 0) {
      return;
    }
    const int side = 1 << (2 * level);  // of a cell, in voxels
    const Eigen::Vector3d low_m = corner_m_ + 4 * side * voxel_m_ * Eigen::Vector3d(at.x, at.y, at.z);
    std::uint32_t asked = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      asked |= ((block >> kOctants[i]) & kOctant) != 0 ? 1U << i : 0U;
    }
    const ChildrenSeen seen = look(low_m + Eigen::Vector3d::Constant(2 * side * voxel_m_), 2 * side, asked);
    for (std::uint32_t rest = seen.free; rest != 0; rest &= rest - 1) {
      take_out(level, at, block & (kOctant << kOctants[static_cast<std::size_t>(std::countr_zero(rest))]), block);
    }
    for (std::uint32_t rest = seen.undecided; rest != 0; rest &= rest - 1) {
      visit_octant(level, at, kOctants[static_cast<std::size_t>(std::countr_zero(rest))], low_m, block);
    }
  }

  // NOLINTNEXTLINE(misc-no-recursion): as deep as the pyramid
  void visit_octant(int level, const At& at, int octant, const Eigen::Vector3d& low_m, Block& block) noexcept {
    const int side = 1 << (2 * level);
    std::uint32_t asked = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      asked |= static_cast<std::uint32_t>((block >> (octant + kCells[i])) & 1U) << i;
    }
    const Eigen::Vector3d first(octant & 3, (octant >> 2) & 3, octant >> 4);
    const Eigen::Vector3d middle = low_m + side * voxel_m_ * (first + Eigen::Vector3d::Ones());
    const ChildrenSeen seen = look(middle, side, asked);
    Block gone = 0;
    for (std::uint32_t rest = seen.free; rest != 0; rest &= rest - 1) {
      gone |= Block{1} << (octant + kCells[static_cast<std::size_t>(std::countr_zero(rest))]);
    }
    for (std::uint32_t rest = seen.undecided; rest != 0; rest &= rest - 1) {
      const int cell = octant + kCells[static_cast<std::size_t>(std::countr_zero(rest))];
      const At below{4 * at.x + (cell & 3), 4 * at.y + ((cell >> 2) & 3), 4 * at.z + (cell >> 4)};
      if (level == 0) {
        gone |= is_free(below) ? Block{1} << cell : Block{0};
      } else {
        visit(level - 1, below);
        block &= voxels_.block(level - 1, below.x, below.y, below.z) != 0 ? ~Block{0} : ~(Block{1} << cell);
      }
    }
    take_out(level, at, gone, block);
  }

  /// The ball of a single voxel.
  [[nodiscard]] bool is_free(const At& voxel) const noexcept {
    const Eigen::Vector3d x_m =
        corner_m_ + voxel_m_ * (Eigen::Vector3d(voxel.x, voxel.y, voxel.z) + Eigen::Vector3d::Constant(0.5));
    const Eigen::Vector3d p = carver_.camera.to_camera(x_m);
    return !views::meets_not_known_free(carver_.camera, views::Clip{}, p, carver_.radius_m(p));
  }

  /// Everything below these cells, and them.
  // NOLINTNEXTLINE(misc-no-recursion): as deep as the pyramid
  void take_out(int level, const At& at, Block cells, Block& block) noexcept {
    block &= ~cells;
    if (level == 0) {
      removed_ += std::popcount(cells);
      return;
    }
    for (; cells != 0; cells &= cells - 1) {
      const int cell = std::countr_zero(cells);
      const At below{4 * at.x + (cell & 3), 4 * at.y + ((cell >> 2) & 3), 4 * at.z + (cell >> 4)};
      Block& inner = voxels_.block(level - 1, below.x, below.y, below.z);
      take_out(level - 1, below, inner, inner);
    }
  }

  const Carver& carver_;
  VoxelSet& voxels_;
  Eigen::Vector3d corner_m_;
  double voxel_m_;
  std::int64_t removed_ = 0;
};

}  // namespace

double reach_around_centre_m(const PossibleSpace& space, double thinnest_hidden_m) noexcept {
  return std::max(0.0, kVoxelHalfDiagonal * space.voxels.voxel_m() + space.pending_m - 0.5 * thinnest_hidden_m);
}

Carver make_carver(const views::Snapshot& snapshot, std::size_t camera, double late_s, const FreeMaxima& maxima,
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
  carver.maxima = &maxima;
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

std::int64_t carve(const Carver& carver, VoxelSet& voxels) noexcept { return Carving(carver, voxels).run(); }

}  // namespace depthgrid::memory
