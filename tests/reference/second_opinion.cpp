#include "reference/second_opinion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace depthgrid::reference {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// a . (x, y, z, 1) <= 0 in the camera frame, moved to the world frame.
HalfSpace half_space(const CameraInput& camera, const Vector4d& a_camera) {
  const Matrix4d T_camera_world = camera.T_world_camera.matrix().inverse();
  const Vector4d a = T_camera_world.transpose() * a_camera;
  const double length = a.head<3>().norm();
  return {a.head<3>() / length, -a.w() / length};
}

/// The four half spaces u_low <= u <= u_high, v_low <= v <= v_high of image coordinates, for z > 0.
Polyhedron pyramid(const CameraInput& camera, double u_low, double u_high, double v_low, double v_high) {
  const PinholeCamera& c = camera.camera;
  return {half_space(camera, {-c.fx_px, 0, u_low - c.cx_px, 0}), half_space(camera, {c.fx_px, 0, c.cx_px - u_high, 0}),
          half_space(camera, {0, -c.fy_px, v_low - c.cy_px, 0}), half_space(camera, {0, c.fy_px, c.cy_px - v_high, 0})};
}

HalfSpace at_least(const CameraInput& camera, double z_m) { return half_space(camera, {0, 0, -1, z_m}); }
HalfSpace at_most(const CameraInput& camera, double z_m) { return half_space(camera, {0, 0, 1, -z_m}); }

HalfSpace turned(const HalfSpace& h) { return {-h.normal, -h.offset_m}; }

/// D - m(D) or the robot's exit of one pixel alone; 0 outside the image and without measurement.
double reduced_m(const CameraInput& camera, int u, int v) {
  const DepthView& view = camera.frame.depth;
  if (u < 0 || v < 0 || u >= camera.camera.width_px || v >= camera.camera.height_px || view.data == nullptr) {
    return 0;
  }
  const std::optional<float> depth_m = measured_depth_m(view, camera.rule, u, v);
  if (!depth_m) {
    return 0;
  }
  const double front_m = *depth_m - depth_margin_m(camera.sensor, *depth_m);
  const RobotView& robot = camera.frame.robot;
  if (robot.near_m != nullptr) {
    const std::ptrdiff_t i = robot.stride_px * v + u;
    if (robot.near_m[i] > 0 && front_m >= robot.near_m[i] && *depth_m <= robot.far_m[i]) {
      return robot.far_m[i];
    }
  }
  return std::max(front_m, 0.0);
}

}  // namespace

std::vector<Polyhedron> pieces_not_free(const CameraInput& camera) {
  const PinholeCamera& c = camera.camera;
  std::vector<Polyhedron> pieces;
  for (const HalfSpace& border : pyramid(camera, 0, c.width_px, 0, c.height_px)) {
    pieces.push_back({turned(border)});
  }
  pieces.push_back({at_most(camera, 0)});
  for (int v = 0; v < c.height_px; ++v) {
    for (int u = 0; u < c.width_px; ++u) {
      double free_m = kInfinity;
      for (int dv = -camera.sensor.lateral_px; dv <= camera.sensor.lateral_px; ++dv) {
        for (int du = -camera.sensor.lateral_px; du <= camera.sensor.lateral_px; ++du) {
          free_m = std::min(free_m, reduced_m(camera, u + du, v + dv));
        }
      }
      // The pixel's depths are cut at all limits; the stretches between two cuts are free, robot or neither.
      std::vector<double> cuts{0, camera.rule.near_m, free_m};
      double robot_near_m = 1;
      double robot_far_m = 0;
      const RobotView& robot = camera.frame.robot;
      if (robot.near_m != nullptr && robot.near_m[robot.stride_px * v + u] > 0) {
        robot_near_m = robot.near_m[robot.stride_px * v + u];
        robot_far_m = robot.far_m[robot.stride_px * v + u];
        cuts.push_back(robot_near_m);
        cuts.push_back(robot_far_m);
      }
      std::sort(cuts.begin(), cuts.end());
      cuts.push_back(kInfinity);
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double middle_m = std::isinf(cuts[i + 1]) ? cuts[i] + 1 : 0.5 * (cuts[i] + cuts[i + 1]);
        const bool free = middle_m > camera.rule.near_m && middle_m < free_m;
        const bool in_robot = middle_m > robot_near_m && middle_m < robot_far_m;
        if (cuts[i + 1] > cuts[i] && !free && !in_robot) {
          Polyhedron piece = pyramid(camera, u, u + 1, v, v + 1);
          piece.push_back(at_least(camera, cuts[i]));
          if (!std::isinf(cuts[i + 1])) {
            piece.push_back(at_most(camera, cuts[i + 1]));
          }
          pieces.push_back(std::move(piece));
        }
      }
    }
  }
  return pieces;
}

Polyhedron view_polyhedron(const CameraInput& camera, double d_min_m, double d_max_m) {
  Polyhedron view = pyramid(camera, 0, camera.camera.width_px, 0, camera.camera.height_px);
  view.push_back(at_least(camera, d_min_m));
  view.push_back(at_most(camera, d_max_m));
  return view;
}

bool contains(const Polyhedron& polyhedron, const Vector3d& p, double slack_m) {
  return std::all_of(polyhedron.begin(), polyhedron.end(),
                     [&](const HalfSpace& h) { return h.normal.dot(p) <= h.offset_m + slack_m; });
}

double distance_m(const Polyhedron& polyhedron, const Vector3d& p, double enough_m) {
  constexpr double kSlackM = 1e-9;
  double least_m = 0;
  for (const HalfSpace& h : polyhedron) {
    least_m = std::max(least_m, h.normal.dot(p) - h.offset_m);
  }
  if (least_m >= enough_m) {
    return kInfinity;
  }
  if (contains(polyhedron, p, 0)) {
    return 0;
  }
  const int n = static_cast<int>(polyhedron.size());
  // The projection is x = p - sum of lambda_i n_i over at most three planes that x lies on, with lambda_i >= 0.
  const auto attempt = [&](std::initializer_list<int> active) {
    const int size = static_cast<int>(active.size());
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> normals(size, 3);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> excess(size);
    int row = 0;
    for (const int i : active) {
      const HalfSpace& h = polyhedron[static_cast<std::size_t>(i)];
      normals.row(row) = h.normal.transpose();
      excess(row++) = h.normal.dot(p) - h.offset_m;
    }
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = normals * normals.transpose();
    if (std::abs(gram.determinant()) < 1e-14) {
      return kInfinity;
    }
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> lambda = gram.fullPivLu().solve(excess);
    if ((lambda.array() < -1e-12).any()) {
      return kInfinity;
    }
    const Vector3d x = p - normals.transpose() * lambda;
    return contains(polyhedron, x, kSlackM) ? (x - p).norm() : kInfinity;
  };
  double best_m = kInfinity;
  for (int i = 0; i < n; ++i) {
    best_m = std::min(best_m, attempt({i}));
    for (int j = i + 1; j < n; ++j) {
      best_m = std::min(best_m, attempt({i, j}));
      for (int k = j + 1; k < n; ++k) {
        best_m = std::min(best_m, attempt({i, j, k}));
      }
    }
  }
  return best_m;
}

double exact_distance_m(const Problem& problem, const Vector3d& p_world) {
  const auto& space = std::get<FrustumSpace>(problem.space);
  const Polyhedron view = view_polyhedron(problem.cameras[space.principal], space.d_min_m, space.d_max_m);
  double best_m = problem.rho_m;
  bool found = false;
  // Pieces near enough to matter, one list a camera; a single camera is intersected with everything.
  const auto near_pieces = [&](std::size_t k) {
    std::vector<Polyhedron> pieces;
    for (Polyhedron& piece : pieces_not_free(problem.cameras[k])) {
      // Of the principal camera's half spaces outside the image only the border belongs to W.
      if ((k != space.principal || piece.size() > 1) && distance_m(piece, p_world, best_m) < best_m) {
        pieces.push_back(std::move(piece));
      }
    }
    return pieces;
  };
  const std::vector<Polyhedron> first = near_pieces(0);
  const std::vector<Polyhedron> second =
      problem.cameras.size() > 1 ? near_pieces(1) : std::vector<Polyhedron>{Polyhedron{}};
  for (const Polyhedron& a : first) {
    for (const Polyhedron& b : second) {
      Polyhedron both = view;
      both.insert(both.end(), a.begin(), a.end());
      both.insert(both.end(), b.begin(), b.end());
      const double both_m = distance_m(both, p_world, best_m);
      if (both_m < best_m) {
        best_m = both_m;
        found = true;
      }
    }
  }
  return found ? best_m : kInfinity;
}

}  // namespace depthgrid::reference
