// The sound search: the distance from points, spheres and capsules to everything that no camera has seen free.
//
//   free_k = { x : x projects inside image k and near_k < z_k(x) < g_k(pixel of x) },  N_k = W minus free_k
//   O      = intersection over k of { x in W : some y in N_k minus R_k has |x - y| <= e_k(x) }
//   D(P)   = distance from P to O, capped at rho
//
// Answers never exceed D(P). Tight to r: the nearest point w of an answer below rho has |w - P| = answer (to 1e-5 m)
// and lies within e_k(w) + r of N_k minus R_k for every camera k.
//
// A best-first search over the cubes of an octree around the primitive: a cube is dropped when one camera alone frees
// it with everything that errors of pose and time may bring into it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/proximity.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::search {

/// Subtracted from every answer: covers the rounding of single-precision geometry near the cameras.
inline constexpr double kRounding = 1e-5;

/// One primitive's answer.
struct Answer {
  /// distance_m: from the primitive's surface to O, 0 when they touch; lower bound when `budget`. nearest_world: the
  /// nearest point of O (to the resolution). direction_world: unit vector from the primitive's axis to it.
  Proximity nearest;
  /// The axis' point nearest to nearest.nearest_world; the point itself for a point or a sphere. NaN where there is no
  /// nearest point.
  Eigen::Vector3d on_axis_world = Eigen::Vector3d::Constant(Proximity::kNaN);
  /// Only after hybrid(): unit vector n + b (t - (t.n) n), normalised, with n the nearest direction and t the mean of
  /// the unit vectors to all obstacle space within rho, weighted by the repulsion v(D). Its product with n is at least
  /// 0.707. Zero when there is no obstacle within rho or the primitive touches it.
  Eigen::Vector3d hybrid_direction_world = Eigen::Vector3d::Zero();
};

/// Stops a call early. 0: no limit. When it runs out the answers that are not finished hold the lower bound reached
/// so far, with nearest.budget set.
struct Budget {
  std::int64_t nodes = 0;  ///< octree cells that the call may open, over all primitives
  double time_s = 0;       ///< wall clock; looked at every few microseconds
};

/// Work done, for figures.
struct Count {
  std::int64_t nodes = 0;       ///< octree cells opened
  std::int64_t ball_tests = 0;  ///< exact tests of a ball against one camera
};

struct Nearest;

/// Scratch memory of one thread; everything is allocated by the constructor. Not for two threads at once.
class Search {
 public:
  /// For snapshots of any store and calls of any size.
  Search();
  ~Search();
  Search(Search&&) noexcept;
  Search& operator=(Search&&) noexcept;
  Search(const Search&) = delete;
  Search& operator=(const Search&) = delete;

  /// Distances of many primitives. answers.size() should equal primitives.size(); answers without a primitive, and
  /// those of primitives that are not finite or have a negative radius, are not_evaluated. Primitives beside each
  /// other in the call that are near to each other are searched together. Does not allocate, lock or throw.
  void distances(const views::Snapshot& snapshot, std::span<const Capsule> primitives, std::span<Answer> answers,
                 const Budget& budget = {}, Count* count = nullptr) noexcept;

  /// The same with hybrid_direction_world, equation (11) in its corrected form.
  void hybrid(const views::Snapshot& snapshot, std::span<const Capsule> primitives, std::span<Answer> answers,
              const Budget& budget = {}, Count* count = nullptr) noexcept;

 private:
  struct State;
  struct Plan;
  [[nodiscard]] static bool plan(const views::Snapshot& snapshot, const Capsule& primitive, Answer& result,
                                 Plan& plan) noexcept;
  static void finish(const views::Snapshot& snapshot, const Plan& plan, const Nearest& found,
                     const Eigen::Vector3d& origin_world, Answer& result) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::search
