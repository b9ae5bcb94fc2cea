// A second description of the same set, written differently: convex polyhedra in the world frame instead of pixels and
// projections. Exact and very slow; it checks the oracle on tiny images.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/reference.hpp"

namespace depthgrid::reference {

/// { x : normal . x <= offset_m }, unit normal, world frame.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset_m;
};
using Polyhedron = std::vector<HalfSpace>;

/// The closure of N_k minus R_k as a union of convex pieces: for each pixel what is left of its pyramid beyond g and
/// beyond the robot, the blind zone, and the half spaces outside the image.
std::vector<Polyhedron> pieces_not_free(const CameraInput& camera);

/// The view of a camera between two depths.
Polyhedron view_polyhedron(const CameraInput& camera, double d_min_m, double d_max_m);

/// Whether p lies in the polyhedron grown by `slack_m` (negative: well inside).
bool contains(const Polyhedron& polyhedron, const Eigen::Vector3d& p, double slack_m);

/// Distance from p to the polyhedron, found by enumerating the active sets until one satisfies the optimality
/// conditions; infinity when the polyhedron is empty. Stops early with infinity when it is at least `enough_m`.
double distance_m(const Polyhedron& polyhedron, const Eigen::Vector3d& p, double enough_m);

/// Exact D(P) for one or two cameras without pose margins, W the principal's view, everything outside W ignored;
/// infinity when there is nothing within rho.
double exact_distance_m(const Problem& problem, const Eigen::Vector3d& p_world);

}  // namespace depthgrid::reference
