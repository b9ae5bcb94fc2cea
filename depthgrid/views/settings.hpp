// What the sound search is asked to answer. Nothing that decides what counts as an obstacle has a silent default.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/repulsion_law.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::views {

/// Most cameras of one rig.
inline constexpr std::size_t kMaxCameras = 16;

/// W = what the principal camera sees between two depths: the letter's space, comparable with the grid evaluators.
struct FrustumSpace {
  std::size_t principal = 0;  ///< index in the rig
  double d_min_m = 0;
  double d_max_m = 0;
};

/// W = a box with axes along the world's: no principal camera.
struct BoxSpace {
  Eigen::Vector3d low_world;
  Eigen::Vector3d high_world;
};

/// Whether space counts as obstacle. There is no default: validate() refuses `undeclared`.
enum class Policy : std::uint8_t { undeclared, obstacle, ignored };

/// What counts as obstacle beyond what the cameras have not seen free.
struct Policies {
  /// Space inside W that no camera covers (geometrically: image and blind zone, never the validity of a pixel).
  Policy unobserved = Policy::undeclared;
  /// Space outside W. `obstacle`: D = min(D, distance to W's border). `ignored`: the answer carries that distance as
  /// known_to_m, and a point outside W has no distance.
  Policy outside = Policy::undeclared;
  /// The shadow right behind the robot, which thin unknown pockets fill in most poses. `obstacle` counts it. `ignored`
  /// lets every robot pixel free `ignored_pocket_m` beyond the robot's exit: an obstacle thinner than that may hide
  /// right behind the robot from every camera. Gives up soundness for such obstacles, and only there.
  Policy robot_pockets = Policy::undeclared;
  double ignored_pocket_m = 0;
};

/// - Units: metres, seconds, m/s, world frame.
/// - To be set: space, the three policies, margins with each camera's smallest obstacle, v_max_m_s. The rest has
///   defaults.
/// - Errors: validate() throws Error.
struct Settings {
  std::variant<std::monostate, FrustumSpace, BoxSpace> space;  ///< W, at most 32,768 resolutions wide; has to be set
  Policies policies;
  std::vector<CameraMargins> margins;  ///< one a camera, in the rig's order
  double rho_m = kDefaultRho;          ///< surveillance radius, from the primitive's surface
  double resolution_m = 0.005;         ///< tightness: the nearest point lies within this (and e_k) of every N_k
  /// Fastest obstacle. Enters e_k = translation + rotation |x - c_k| + (1 + rotation) v_max (|t_k - t_ref| + half
  /// exposure + time uncertainty). With 0 a time skew between cameras is not covered.
  double v_max_m_s = std::numeric_limits<double>::quiet_NaN();       ///< has to be set
  double max_frame_age_s = std::numeric_limits<double>::infinity();  ///< older than the newest by more: stale
  double direction_blend = kDefaultBlend;  ///< b in [0, 1] of the hybrid direction: weight of the other obstacles
  double repulsion_alpha = kDefaultAlpha;  ///< shape of the repulsion that weights them
};

/// Throws Error with value, rule and hint unless every part is set and in range for this rig.
void validate(const Settings& settings, const Rig& rig);

/// C++ that makes the same settings, to the bit: for a report that can be run again.
[[nodiscard]] std::string to_string(const Settings& settings);

}  // namespace depthgrid::views
