// The search for the nearest obstacle of one primitive.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <optional>

#include "depthgrid/search/cube_test.hpp"
#include "depthgrid/search/primitive.hpp"
#include "depthgrid/search/search.hpp"

namespace depthgrid::search {

/// What is left of a call's budget.
struct Allowance {
  std::int64_t nodes = 0;
  std::chrono::steady_clock::time_point deadline;
  bool timed = false;
};

/// Positions relative to the query's origin, metres.
struct Nearest {
  double distance_m = 0;  ///< from the axis; a lower bound where `stopped`
  bool found = false;     ///< else nothing within the limit was found
  bool stopped = false;   ///< by the allowance, or because the frontier was full
  Eigen::Vector3d on_axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d in_obstacle = Eigen::Vector3d::Zero();
};

/// The search on one snapshot, for one primitive after the other.
class Descent {
 public:
  Descent(const Snapshot& snapshot, CubeQuery& query, Frontier& frontier, Count& count) noexcept;

  /// Makes everything relative to a place near the primitive. `reach_m`: how far from the axis is of interest.
  void aim(const Primitive& primitive, double reach_m) noexcept;

  /// Nearest obstacle within limit_m (at most what aim() was told) of the axis; with a radius, any obstacle within it
  /// ends the search.
  [[nodiscard]] Nearest find(double limit_m, Allowance& allowance) noexcept;

  /// Mean of the unit vectors from the axis to all obstacle space within rho of the primitive's surface, weighted by
  /// volume and by the repulsion v(D) = 1 / (1 + exp((2 D / rho - 1) alpha)). Cubes are split until their side is about a
  /// third of their distance or 1/16 of rho, and count as their centre does. Zero when there is no such space.
  [[nodiscard]] Eigen::Vector3d mean_direction(Allowance& allowance) noexcept;

  [[nodiscard]] const Eigen::Vector3d& origin_world() const noexcept { return origin_world_; }

 private:
  struct Box {
    Eigen::Vector3d low, high;
  };

  void set_origin(const Eigen::Vector3d& origin_world, double extent_m) noexcept;
  [[nodiscard]] Box box_of(const Cube& cube) const noexcept;
  [[nodiscard]] float half_side_m(int level) const noexcept { return half_m_[static_cast<std::size_t>(level)]; }
  [[nodiscard]] bool is_blocked(const Eigen::Vector3d& x_local, double slack_m) const noexcept;
  [[nodiscard]] bool in_space(const Eigen::Vector3d& x_local) const noexcept;
  [[nodiscard]] bool is_free(const Cube& cube) noexcept;
  [[nodiscard]] bool is_leaf(const Cube& cube) noexcept;
  void offer(const Cube& cube, Nearest& best) noexcept;
  void take(const Children& children, Nearest& best) noexcept;

  const Snapshot& snapshot_;
  const Settings& settings_;
  CubeQuery& query_;
  Frontier& frontier_;
  Count& count_;
  double radius_m_ = 0;
  Eigen::Vector3d origin_world_;
  double extent_m_ = -1;  ///< how far from the origin the cameras' single-precision guards hold
  Eigen::Vector3d a_local_, b_local_;
  Eigen::Vector3d space_low_, space_high_;
  Cube root_{};
  static constexpr std::size_t kLevels = 64;
  std::array<float, kLevels> half_m_{};
  bool has_reach_ = false;   ///< of some camera
  double largest_rate_ = 0;  ///< of the cameras' reach with range
  double leaf_half_m_ = 0;
  double least_reach_m_ = 0;
  int leaf_level_ = 0;       ///< cubes of this level are not split any further
  int last_level_ = 0;       ///< but where the border of a frustum W runs through one it is split down to this level
  int exact_level_ = 0;      ///< from this level on a ball is tested too, not only a box, because of the cameras' reach
};

}  // namespace depthgrid::search
