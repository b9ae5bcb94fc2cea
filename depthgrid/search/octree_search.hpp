// The search for the nearest obstacles of a group of primitives. Internal.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/search/axis_distance.hpp"
#include "depthgrid/search/cube_split.hpp"
#include "depthgrid/search/remaining_budget.hpp"
#include "depthgrid/search/search.hpp"

namespace depthgrid::search {

/// One primitive's search. Positions relative to the search's origin, metres.
struct Nearest {
  double limit_m = 0;     ///< how far from the axis an obstacle is of interest
  double distance_m = 0;  ///< from the axis; limit_m when nothing nearer was found; a lower bound where `stopped`
  bool found = false;
  bool stopped = false;  ///< by the budget, or because the frontier was full
  Eigen::Vector3d on_axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d in_obstacle = Eigen::Vector3d::Zero();
};

/// The search on one snapshot, for groups of primitives that are near to each other: their cubes are tested once.
class OctreeSearch {
 public:
  OctreeSearch(const views::Snapshot& snapshot, CubeQuery& query, Frontier& frontier, Count& count) noexcept;

  /// Starts a group around a place; extent_m: how far from it the axes and what is of interest around them reach.
  void aim(const Eigen::Vector3d& middle_world, double extent_m) noexcept;

  /// Adds a primitive (at most kGroup) whose obstacles within limit_m of its axis are of interest. Returns its index.
  std::size_t add(const Capsule& primitive, double limit_m) noexcept;

  /// Finds the nearest obstacles of all primitives of the group. One within a primitive's radius ends its search.
  void find(RemainingBudget& budget) noexcept;
  [[nodiscard]] const Nearest& nearest_of(std::size_t i) const noexcept { return found_[i]; }

  /// Mean of the unit vectors from the axis to all obstacle space within rho of the primitive's surface, weighted by
  /// volume and by the repulsion v(D). Cubes are split until their side is about
  /// a third of their distance or 1/16 of rho, and count as their centre does. For all primitives of the group for
  /// which `wanted` has its bit; zero where there is no such space.
  void find_mean_directions(std::uint32_t wanted, std::span<Eigen::Vector3d> means, RemainingBudget& budget) noexcept;

  [[nodiscard]] const Eigen::Vector3d& origin_world() const noexcept { return origin_world_; }

 private:
  struct Box {
    Eigen::Vector3d low, high;
  };
  struct LocalAxis {
    Eigen::Vector3d a, b;
    double radius_m = 0;
  };

  void set_origin(const Eigen::Vector3d& origin_world, double extent_m) noexcept;
  [[nodiscard]] Box box_of(const Cube& cube) const noexcept;
  [[nodiscard]] float half_side_m(int level) const noexcept { return half_m_[static_cast<std::size_t>(level)]; }
  [[nodiscard]] bool is_blocked(const Eigen::Vector3d& x_local, double slack_m) const noexcept;
  [[nodiscard]] bool in_space(const Eigen::Vector3d& x_local) const noexcept;
  [[nodiscard]] bool is_free(const Cube& cube) noexcept;
  [[nodiscard]] bool is_leaf(const Cube& cube, const LocalAxis& axis) const noexcept;
  [[nodiscard]] AxisToBox towards_centre(const Cube& cube, const LocalAxis& axis) const noexcept;
  [[nodiscard]] bool is_of_interest(const Cube& cube) const noexcept;
  [[nodiscard]] std::uint32_t all_primitives() const noexcept;
  void set_bound(std::size_t i, double bound_m) noexcept;
  void offer(const AxisToBox& pair, std::size_t i) noexcept;
  void take(Children& children) noexcept;
  [[nodiscard]] std::uint32_t add_piece(const Cube& cube, std::span<Eigen::Vector3d> means,
                                        std::array<double, kGroup>& total) const noexcept;
  void stop(std::uint32_t primitives, double at_m) noexcept;

  const views::Snapshot& snapshot_;
  const views::Settings& settings_;
  CubeQuery& query_;
  Frontier& frontier_;
  Count& count_;
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();
  double extent_m_ = -1;  ///< how far from the origin the cameras' single-precision guards hold
  std::size_t axis_count_ = 0;
  std::array<LocalAxis, kGroup> axes_;
  std::array<Nearest, kGroup> found_;
  Eigen::Vector3d space_low_, space_high_;
  Cube root_{};
  static constexpr std::size_t kLevels = 64;
  std::array<float, kLevels> half_m_{};
  double largest_rate_ = 0;  ///< of the cameras' pose error with range
  double leaf_half_m_ = 0;
  double least_pose_error_m_ = 0;
  int leaf_level_ = 0;  ///< cubes of this level are not split any further
  int last_level_ = 0;  ///< but where the border of a frustum W runs through one it is split down to this level
  int exact_level_ =
      0;  ///< from this level on a ball is tested too, not only a box, because of the cameras' pose error
};

}  // namespace depthgrid::search
