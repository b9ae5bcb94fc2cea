// The nearest leaf that a search has found so far. Internal.
#pragma once

#include <Eigen/Core>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/search/axis_distance.hpp"
#include "depthgrid/search/exact_tests.hpp"
#include "depthgrid/search/near_children.hpp"

namespace depthgrid::search {

/// What one capsule asks, relative to the lattice's origin, metres.
struct Question {
  Question(const CubeQuery& query, const Capsule& capsule, double limit_m_in) noexcept;

  Eigen::Vector3d a, b;
  double limit_m;  ///< how far from the axis an obstacle is of interest
  Axis axis;
};

/// Positions relative to the lattice's origin, metres.
struct Nearest {
  double distance_m = 0;  ///< from the axis; the limit when nothing nearer was found; a lower bound where `stopped`
  bool found = false;
  bool stopped = false;  ///< by the budget, or because there was no room
  Eigen::Vector3d on_axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d in_obstacle = Eigen::Vector3d::Zero();
};

/// Whether the axis itself lies in an obstacle, as far as a few of its points tell. Then the answer is the first of
/// them.
[[nodiscard]] bool touches(const CubeQuery& query, const Question& question, Nearest& nearest) noexcept;

/// The nearest of the leaves that were offered, in whatever order: of two at the same distance the one that comes first
/// by its place.
class NearestLeaf {
 public:
  NearestLeaf(const CubeQuery& query, const Question& question) noexcept
      : query_(query), question_(question), distance_m_(question.limit_m) {
    look_within(question.limit_m);
  }

  /// False if the cube has to be split further, because the border of W runs through it.
  bool offer(const Cube& leaf) noexcept;
  /// Cubes have to be nearer than this to matter, a little more because of single precision.
  [[nodiscard]] float bound_m() const noexcept { return bound_m_; }
  /// Only what is that near is looked for from here on.
  void look_within(double distance_m) noexcept;

  [[nodiscard]] bool found() const noexcept { return found_; }
  [[nodiscard]] double distance_m() const noexcept { return distance_m_; }
  [[nodiscard]] const Cube& leaf() const noexcept { return leaf_; }
  [[nodiscard]] Nearest nearest() const noexcept;

 private:
  const CubeQuery& query_;
  const Question& question_;
  double distance_m_;
  float bound_m_ = 0;
  bool found_ = false;
  AxisToBox pair_{};
  Cube leaf_{};
};

}  // namespace depthgrid::search
