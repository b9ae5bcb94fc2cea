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

/// One primitive and what it is searched in.
class Descent {
 public:
  Descent(const Snapshot& snapshot, CubeQuery& query, Frontier& frontier, Count& count) noexcept
      : snapshot_(snapshot), settings_(snapshot.settings()), query_(query), frontier_(frontier), count_(count) {}

  /// Makes everything relative to the middle of the primitive's axis. `reach_m`: how far from the axis is of interest.
  void aim(const Primitive& primitive, double reach_m) noexcept;

  /// Nearest obstacle within limit_m (at most what aim() was told) of the axis; with a radius, any obstacle within it
  /// ends the search.
  [[nodiscard]] Nearest find(double limit_m, Allowance& allowance) noexcept;

  [[nodiscard]] const Eigen::Vector3d& origin_world() const noexcept { return origin_world_; }

  // For the hybrid direction's walk over the same octree.
  [[nodiscard]] Cube root() const noexcept { return {0, 0, 0, 0, 0}; }
  [[nodiscard]] float half_side_m(int level) const noexcept { return half_m_[static_cast<std::size_t>(level)]; }
  /// x lies in O as far as the pixels that x projects to tell: every camera has it behind its free depth (up to
  /// slack_m along the ray) or out of its view.
  [[nodiscard]] bool is_blocked(const Eigen::Vector3d& x_local, double slack_m) noexcept;

 private:
  struct Box {
    Eigen::Vector3d low, high;
    [[nodiscard]] Eigen::Vector3d centre() const { return 0.5 * (low + high); }
  };
  enum class Verdict : std::uint8_t { free, undecided, obstacle };

  [[nodiscard]] Box box_of(const Cube& cube) const noexcept;
  [[nodiscard]] bool blocks(const LocalCamera& camera, const Eigen::Vector3d& x_local, double slack_m) const noexcept;
  [[nodiscard]] bool in_space(const Eigen::Vector3d& x_local) const noexcept;
  [[nodiscard]] bool is_free(const Box& box) noexcept;
  [[nodiscard]] Verdict judge(const Cube& cube, const Box& box, const Eigen::Vector3d& nearest_local) noexcept;

  const Snapshot& snapshot_;
  const Settings& settings_;
  CubeQuery& query_;
  Frontier& frontier_;
  Count& count_;
  Primitive primitive_;
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_local_, b_local_;
  Eigen::Vector3d space_low_, space_high_;
  static constexpr std::size_t kLevels = 40;
  std::array<float, kLevels> half_m_{};
  int leaf_level_ = 0;        ///< cubes of this level have a diagonal within the resolution
  int last_level_ = 0;        ///< where the border of W runs through a cube, it is split down to this level
  float exact_below_m_ = 0;   ///< half side from which on balls are tested, not boxes, because of the cameras' reach
};

}  // namespace depthgrid::search
