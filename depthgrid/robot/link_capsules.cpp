#include "depthgrid/robot/link_capsules.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/capsule_fit.hpp"
#include "depthgrid/robot/mesh.hpp"

namespace depthgrid::robot {

namespace {

using Eigen::Vector3d;

Capsule moved(const Pose& T_A_B, const Capsule& capsule) {
  return {T_A_B * capsule.a, T_A_B * capsule.b, capsule.radius_m};
}

/// How far the centre of a sphere may be from the end of a cylinder that it rounds off: digits of a file.
constexpr double kSamePlace = 1e-5;

struct Ball {
  Vector3d centre;
  double radius_m;
  bool used = false;
};

/// A ball at p that is at least as wide, or null.
Ball* ball_at(std::vector<Ball>& balls, const Vector3d& p, double radius_m) {
  for (Ball& ball : balls) {
    if ((ball.centre - p).norm() <= kSamePlace && ball.radius_m >= radius_m - kSamePlace) {
      return &ball;
    }
  }
  return nullptr;
}

/// The cylinder with its round ends where the link has such balls, else the smallest capsule around it.
Capsule rounded(const CylinderShape& cylinder, const Pose& T_link_shape, std::vector<Ball>& balls) {
  const Vector3d half(0, 0, 0.5 * cylinder.length_m);
  Ball* const a = ball_at(balls, T_link_shape * Vector3d(-half), cylinder.radius_m);
  Ball* const b = ball_at(balls, T_link_shape * half, cylinder.radius_m);
  if (a == nullptr || b == nullptr) {
    return moved(T_link_shape, around(cylinder));
  }
  a->used = b->used = true;
  const double off_m =
      std::max((a->centre - T_link_shape * Vector3d(-half)).norm(), (b->centre - T_link_shape * half).norm());
  return {a->centre, b->centre, std::max({a->radius_m, b->radius_m, cylinder.radius_m + off_m})};
}

Capsule around_mesh(const MeshShape& mesh, const Pose& T_link_shape) {
  constexpr double kMaxCoordinate_m = 10;
  constexpr double kLeastSize_m = 2e-4;
  std::vector<Vector3d> points = mesh_points(mesh.file);
  Eigen::AlignedBox3d box;
  for (Vector3d& p : points) {
    p = p.cwiseProduct(mesh.scale);
    if (!p.allFinite() || !(p.cwiseAbs().maxCoeff() <= kMaxCoordinate_m)) {
      fail(mesh.file.string(), ": at scale (", mesh.scale.transpose(), ") a corner is (", p.transpose(),
           ") m, must be within ", kMaxCoordinate_m, " m; in millimetres? did you mean scale='0.001 0.001 0.001'?");
    }
    box.extend(p);
    p = T_link_shape * p;
  }
  if (!(box.sizes().maxCoeff() >= kLeastSize_m)) {
    fail(mesh.file.string(), ": at scale (", mesh.scale.transpose(), ") the mesh is ", box.sizes().maxCoeff(),
         " m long, must be at least ", kLeastSize_m, " m; is the file in metres already? did you mean scale='1 1 1'?");
  }
  if (!has_area(points)) {
    fail(mesh.file.string(), ": at scale (", mesh.scale.transpose(), ") the mesh has no area");
  }
  return fit_capsule(points);
}

std::vector<Capsule> capsules_of(const LinkDescription& link) {
  std::vector<Ball> balls;
  for (const LinkShape& item : link.shapes) {
    if (const auto* sphere = std::get_if<SphereShape>(&item.shape)) {
      balls.push_back({item.T_link_shape.translation(), sphere->radius_m});
    }
  }
  std::vector<Capsule> result;
  for (const LinkShape& item : link.shapes) {
    if (const auto* cylinder = std::get_if<CylinderShape>(&item.shape)) {
      result.push_back(rounded(*cylinder, item.T_link_shape, balls));
    } else if (const auto* ready = std::get_if<CapsuleShape>(&item.shape)) {
      const Vector3d half(0, 0, 0.5 * ready->length_m);
      result.push_back(moved(item.T_link_shape, {-half, half, ready->radius_m}));
    } else if (const auto* box = std::get_if<BoxShape>(&item.shape)) {
      for (const Capsule& capsule : around(*box)) {
        result.push_back(moved(item.T_link_shape, capsule));
      }
    } else if (const auto* mesh = std::get_if<MeshShape>(&item.shape)) {
      result.push_back(around_mesh(*mesh, item.T_link_shape));
    }
  }
  for (const Ball& ball : balls) {
    if (!ball.used) {
      result.push_back({ball.centre, ball.centre, ball.radius_m});
    }
  }
  return result;
}

}  // namespace

std::vector<LinkCapsule> link_capsules(const RobotModel& model, const CapsuleOptions& options) {
  if (!(std::isfinite(options.margin_m) && options.margin_m >= 0)) {
    fail(model.source(), ": capsule margin is ", options.margin_m, " m, must be finite and not negative");
  }
  std::vector<bool> wanted(model.links().size(), true);
  for (const std::string& name : options.left_out) {
    wanted[model.link_index(name)] = false;
  }
  std::vector<LinkCapsule> result;
  for (std::size_t link = 0; link < wanted.size(); ++link) {
    if (!wanted[link]) {
      continue;
    }
    for (Capsule capsule : capsules_of(model.links()[link])) {
      capsule.radius_m += options.margin_m;
      result.push_back({link, capsule});
    }
  }
  return result;
}

void place(std::span<const LinkCapsule> capsules, std::span<const Pose> T_world_link,
           std::span<Capsule> capsules_world) noexcept {
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    capsules_world[i] = moved(T_world_link[capsules[i].link], capsules[i].capsule);
  }
}

}  // namespace depthgrid::robot
