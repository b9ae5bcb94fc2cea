#include "program/robot/shape_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "depthgrid/robot/mesh.hpp"

namespace depthgrid::program {

namespace {

using Eigen::Vector3d;
using Triangles = std::vector<Vector3d>;

constexpr int kAround = 24;  // faces around a round solid

void add_quad(Triangles& result, const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  result.insert(result.end(), {a, b, c, a, c, d});
}

/// A solid of revolution about z: the outline from the bottom to the top, radius and height.
Triangles revolved(const std::vector<Eigen::Vector2d>& outline) {
  Triangles result;
  const auto at = [](const Eigen::Vector2d& p, int i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    return Vector3d(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
  };
  for (std::size_t k = 0; k + 1 < outline.size(); ++k) {
    for (int i = 0; i < kAround; ++i) {
      add_quad(result, at(outline[k], i), at(outline[k], i + 1), at(outline[k + 1], i + 1), at(outline[k + 1], i));
    }
  }
  return result;
}

/// Half circles below and above a cylinder of this length.
Triangles rounded(double radius_m, double length_m) {
  std::vector<Eigen::Vector2d> outline;
  for (const double end : {-1.0, 1.0}) {
    for (int i = 0; i <= kAround / 4; ++i) {
      const double angle = 2 * std::numbers::pi * (end < 0 ? i - kAround / 4 : i) / kAround;
      outline.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle) + end * 0.5 * length_m);
    }
  }
  return revolved(outline);
}

Triangles box(const Vector3d& size_m) {
  Triangles result;
  const auto corner = [&size_m](int axis, double side, double u, double v) {
    Vector3d p;
    p[axis] = side;
    p[(axis + 1) % 3] = u * side;  // turned with the side, so that all faces look outward
    p[(axis + 2) % 3] = v;
    return Vector3d(0.5 * p.cwiseProduct(size_m));
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      add_quad(result, corner(axis, side, -1, -1), corner(axis, side, 1, -1), corner(axis, side, 1, 1),
               corner(axis, side, -1, 1));
    }
  }
  return result;
}

Triangles in_own_frame(const robot::LinkShape& item) {
  if (const auto* sphere = std::get_if<robot::SphereShape>(&item.shape)) {
    return rounded(sphere->radius_m, 0);
  }
  if (const auto* capsule = std::get_if<robot::CapsuleShape>(&item.shape)) {
    return rounded(capsule->radius_m, capsule->length_m);
  }
  if (const auto* cylinder = std::get_if<robot::CylinderShape>(&item.shape)) {
    const double r = cylinder->radius_m;
    const double h = 0.5 * cylinder->length_m;
    return revolved({{0, -h}, {r, -h}, {r, h}, {0, h}});
  }
  if (const auto* solid = std::get_if<robot::BoxShape>(&item.shape)) {
    return box(solid->size_m);
  }
  const auto& mesh = std::get<robot::MeshShape>(item.shape);
  Triangles result = robot::mesh_points(mesh.file);
  for (Vector3d& p : result) {
    p = p.cwiseProduct(mesh.scale);
  }
  return result;
}

using Edge = std::array<double, 6>;

/// Whether each edge has as many faces on one side as on the other.
bool closes(std::span<const Vector3d> triangles) {
  std::vector<Edge> along;
  std::vector<Edge> back;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& a = triangles[i + k];
      const Vector3d& b = triangles[i + (k + 1) % 3];
      along.push_back({a.x(), a.y(), a.z(), b.x(), b.y(), b.z()});
      back.push_back({b.x(), b.y(), b.z(), a.x(), a.y(), a.z()});
    }
  }
  std::sort(along.begin(), along.end());
  std::sort(back.begin(), back.end());
  return along == back;
}

}  // namespace

Triangles surface_triangles(const robot::LinkShape& shape) {
  Triangles result = in_own_frame(shape);
  for (Vector3d& p : result) {
    p = shape.T_link_shape * p;
  }
  return result;
}

std::optional<double> shape_volume_m3(const robot::LinkShape& shape, std::span<const Vector3d> triangles) {
  constexpr double kPi = std::numbers::pi;
  if (const auto* sphere = std::get_if<robot::SphereShape>(&shape.shape)) {
    return capsule_volume_m3(Capsule::sphere(Vector3d::Zero(), sphere->radius_m));
  }
  if (const auto* capsule = std::get_if<robot::CapsuleShape>(&shape.shape)) {
    return capsule_volume_m3({Vector3d::Zero(), Vector3d(0, 0, capsule->length_m), capsule->radius_m});
  }
  if (const auto* cylinder = std::get_if<robot::CylinderShape>(&shape.shape)) {
    return kPi * cylinder->radius_m * cylinder->radius_m * cylinder->length_m;
  }
  if (const auto* solid = std::get_if<robot::BoxShape>(&shape.shape)) {
    return solid->size_m.prod();
  }
  if (triangles.empty() || !closes(triangles)) {
    return std::nullopt;
  }
  double sixfold = 0;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vector3d& from = triangles.front();  // near, so that little is lost to rounding
    sixfold += (triangles[i] - from).dot((triangles[i + 1] - from).cross(triangles[i + 2] - from));
  }
  return std::abs(sixfold) / 6;  // a scale below 0 turns the faces round
}

double capsule_volume_m3(const Capsule& capsule) noexcept {
  const double r = capsule.radius_m;
  return std::numbers::pi * r * r * ((capsule.b - capsule.a).norm() + 4.0 / 3.0 * r);
}

std::string shape_text(const robot::LinkShape& shape) {
  if (const auto* mesh = std::get_if<robot::MeshShape>(&shape.shape)) {
    return "mesh " + mesh->file.filename().string();
  }
  constexpr std::array<const char*, 5> kNames{"sphere", "cylinder", "capsule", "box", "mesh"};
  return kNames.at(shape.shape.index());
}

}  // namespace depthgrid::program
