// The oracle: a slow and obviously right evaluation of the distance to space that no camera has seen free.
//
//   g_k(pixel) = minimum over the (2w+1)^2 neighbourhood of D_k - m(D_k); no measurement and outside the image count
//                as 0
//   free_k     = { x : x projects inside image k and near_k < z_k(x) < g_k(pixel of x) }
//   N_k        = complement of free_k
//   O          = intersection over k of { x in W : some y in N_k minus R_k has |x - y| <= e_k(x) }
//   D(P)       = distance from the surface of P to O, 0 where they touch, capped at rho
//
// P is a point, a sphere or a capsule, W the space of interest, R_k the robot as camera k sees it, e_k the pose error
// of calibration and time errors. The result is a proven interval: boxes around P are subdivided, nearest first. A box
// is as far as the farthest that one camera alone can prove for what it blocks in it; the upper end is the distance of
// a point that was found to lie in O.
//
// Where space outside W is ignored, a primitive whose axis leaves W has no distance. Where it is an obstacle its
// distance is 0, and otherwise at most that from its surface to W's border.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "reference/camera_space.hpp"
#include "reference/nearness.hpp"
#include "reference/primitive.hpp"

namespace depthgrid::reference {

/// The principal camera's view between two depths.
struct FrustumSpace {
  std::size_t principal = 0;
  double d_min_m = 0;
  double d_max_m = 0;
};

/// What counts beside what the cameras have seen.
enum class Policy : std::uint8_t { ignored, obstacle };

struct Problem {
  std::vector<CameraInput> cameras;
  std::variant<FrustumSpace, WorldBox> space;
  Policy outside = Policy::ignored;     ///< space outside W
  Policy uncovered = Policy::obstacle;  ///< space that no camera covers, whatever was measured
  double rho_m = 0.4;
};

struct SearchSettings {
  double smallest_box_m = 0.5e-3;      ///< boxes of this side are not subdivided any further
  double gap_m = 0.25e-3;              ///< stop as soon as hi - lo is below this
  std::int64_t box_limit = 4'000'000;  ///< boxes looked at; the interval stays valid when it runs out
  /// Nothing beyond this distance matters: lo_m is at most this, and the search ends once lo_m is within gap_m of it.
  double enough_m = std::numeric_limits<double>::infinity();
};

/// lo_m <= D(P) <= hi_m.
struct Interval {
  double lo_m = 0;
  std::optional<double> hi_m;                    ///< none: no point of O was found within rho
  std::optional<Eigen::Vector3d> witness_world;  ///< a point of O at distance hi_m
  bool point_outside = false;                    ///< P's axis leaves W and W's outside is ignored: no distance
  bool limit_reached = false;                    ///< box_limit ran out: lo_m is valid but may be loose
  std::int64_t boxes = 0;

  /// Proven: nothing within rho.
  [[nodiscard]] bool beyond(double rho_m) const { return !point_outside && !hi_m && lo_m >= rho_m; }
};

/// Immutable after construction. Copies what it needs out of the problem's buffers.
class Reference {
 public:
  explicit Reference(const Problem& problem);

  [[nodiscard]] Interval distance(const Primitive& primitive, const SearchSettings& settings = {}) const;
  [[nodiscard]] Interval distance(const Eigen::Vector3d& p_world, const SearchSettings& settings = {}) const {
    return distance(point(p_world), settings);
  }

  /// Exact membership in O, or in the outside of W where that is an obstacle.
  [[nodiscard]] bool is_obstacle(const Eigen::Vector3d& p_world) const;
  [[nodiscard]] bool in_space(const Eigen::Vector3d& p_world) const;
  /// The axis lies in W, which is convex.
  [[nodiscard]] bool in_space(const Primitive& primitive) const {
    return in_space(primitive.a_world) && in_space(primitive.b_world);
  }
  /// From the surface of a primitive whose axis lies in W to W's border, 0 where it reaches out.
  [[nodiscard]] double distance_to_border_m(const Primitive& primitive) const;
  /// How far a point lies beyond the outermost of W's six border planes; negative inside W.
  [[nodiscard]] double outside_by_m(const Eigen::Vector3d& p_world) const;
  /// Some camera covers the point, whatever it measured.
  [[nodiscard]] bool covered(const Eigen::Vector3d& p_world) const;
  [[nodiscard]] std::size_t camera_count() const { return cameras_.size(); }
  [[nodiscard]] const CameraSpace& camera(std::size_t k) const { return cameras_[k]; }

 private:
  /// No point of O in the box is nearer to the axis than the result; infinite: there is none. At least known_m, up to
  /// which it is known already. Not looked into any further from enough_m on.
  [[nodiscard]] double nearest_possible_m(const WorldBox& box, double known_m, double enough_m,
                                          std::vector<Nearness>& cameras,
                                          std::optional<Eigen::Vector3d>& suspect_world) const;
  [[nodiscard]] Eigen::Vector3d nearest_border_point(const Eigen::Vector3d& p_world) const;
  /// The axis' point nearest to W's border, which decides by an end, and the border's nearest point.
  [[nodiscard]] Eigen::Vector3d nearest_border_point(const Primitive& primitive) const;

  std::vector<CameraSpace> cameras_;
  std::variant<FrustumSpace, WorldBox> space_;
  Policy outside_;
  Policy uncovered_;
  double rho_m_;
};

}  // namespace depthgrid::reference
