#include "lab/experiments/film/cell_view.hpp"

#include <algorithm>
#include <cmath>

#include "report/scene_colours.hpp"

namespace depthgrid::experiments {

namespace {

using Eigen::Vector3d;
using simulation::BodyKind;

constexpr double kDensity_per_m = 2.6;  ///< of the haze: 60 cm of it hide four fifths
constexpr double kStep_m = 0.025;
constexpr double kAmbient = 0.45;

Pose looking(const Vector3d& eye, const Vector3d& target) {
  const Vector3d z = (target - eye).normalized();
  const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
  Pose T = Pose::Identity();
  T.linear().col(0) = x;
  T.linear().col(1) = z.cross(x);
  T.linear().col(2) = z;
  T.translation() = eye;
  return T;
}

report::Colour colour_of(const simulation::WorkcellBody& body) {
  switch (body.kind) {
    // The pedestal is no part of the walls.
    case BodyKind::room:
      return body.boxes.empty() ? report::Colour{0.86, 0.85, 0.82} : report::Colour{0.62, 0.60, 0.58};
    case BodyKind::object:
      return {0.74, 0.66, 0.52};
    case BodyKind::robot:
      return report::kRobot;
    case BodyKind::person:
      return report::kPerson;
  }
  return report::kBlack;
}

report::Colour mixed(const report::Colour& a, const report::Colour& b, double share_of_a) {
  const auto part = [&](double x, double y) { return share_of_a * x + (1 - share_of_a) * y; };
  return {part(a.red, b.red), part(a.green, b.green), part(a.blue, b.blue)};
}

}  // namespace

UnknownCubes::UnknownCubes(const Vector3d& low, const Vector3d& high, double side) : low_world(low), side_m(side) {
  std::size_t all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    count[axis] = static_cast<int>(std::lround((high[a] - low[a]) / side));
    all *= static_cast<std::size_t>(count[axis]);
  }
  unknown.assign(all, 0);
}

Vector3d UnknownCubes::centre_world(std::size_t cube) const noexcept {
  const auto nx = static_cast<std::size_t>(count[0]);
  const auto ny = static_cast<std::size_t>(count[1]);
  const std::size_t row = cube / nx;
  const std::size_t layer = row / ny;
  const Vector3d place(static_cast<double>(cube % nx), static_cast<double>(row % ny), static_cast<double>(layer));
  return low_world + side_m * (place + Vector3d::Constant(0.5));
}

bool UnknownCubes::contains_unknown(const Vector3d& p_world) const noexcept {
  const Vector3d place = (p_world - low_world) / side_m;
  std::size_t index = 0;
  for (std::size_t axis = 3; axis-- > 0;) {
    const double at = std::floor(place[static_cast<Eigen::Index>(axis)]);
    if (!(at >= 0 && at < count[axis])) {
      return false;
    }
    index = index * static_cast<std::size_t>(count[axis]) + static_cast<std::size_t>(at);
  }
  return unknown[index] != 0;
}

CellView::CellView(const simulation::Workcell& cell, const Vector3d& eye_world, const Vector3d& target_world,
                   int width_px, int height_px)
    : camera_{width_px, height_px, 1.0 * width_px, 1.0 * width_px, 0.5 * width_px, 0.5 * height_px},
      T_world_camera_(looking(eye_world, target_world)),
      caster_(cell) {}

double CellView::through(const UnknownCubes& haze, const Vector3d& ray_world, double depth_m) const noexcept {
  const double length_m = depth_m * ray_world.norm();
  const Vector3d direction = ray_world.normalized();
  // Only the part of the ray that is in the box.
  double begin_m = 0;
  double end_m = length_m;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double low = haze.low_world[axis] - T_world_camera_.translation()[axis];
    const double high = low + haze.side_m * haze.count[static_cast<std::size_t>(axis)];
    const double a = low / direction[axis];
    const double b = high / direction[axis];
    begin_m = std::max(begin_m, std::min(a, b));
    end_m = std::min(end_m, std::max(a, b));
  }
  double inside_m = 0;
  const int steps = end_m > begin_m ? static_cast<int>(std::ceil((end_m - begin_m) / kStep_m - 0.5)) : 0;
  for (int i = 0; i < steps; ++i) {
    const double at_m = begin_m + (i + 0.5) * kStep_m;
    inside_m += haze.contains_unknown(T_world_camera_.translation() + at_m * direction) ? kStep_m : 0.0;
  }
  return std::exp(-kDensity_per_m * inside_m);
}

report::Raster CellView::draw(const simulation::Workcell& cell, const UnknownCubes& haze) {
  caster_.update(cell);
  caster_.render(camera_, T_world_camera_, depth_m_, bodies_);
  const int width_px = camera_.width_px;
  const int height_px = camera_.height_px;
  const auto ray = [&](int u, int v) {
    return Vector3d((u + 0.5 - camera_.cx_px) / camera_.fx_px, (v + 0.5 - camera_.cy_px) / camera_.fy_px, 1);
  };
  const auto point = [&](int u, int v) { return Vector3d(ray(u, v) * depth_m_.at(u, v)); };
  const auto body = [&](int u, int v) {
    return bodies_.body[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(u)];
  };
  report::Raster raster(width_px, height_px);
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      const Vector3d ray_world = T_world_camera_.linear() * ray(u, v);
      report::Colour colour = report::kWhite;
      double depth_m = 10;
      if (body(u, v) != workcell::BodyImage::kNone) {
        depth_m = depth_m_.at(u, v);
        // The plane through the pixel and two neighbours of its body; at a border the neighbours on the other side.
        const int right = u + 1 < width_px && body(u + 1, v) == body(u, v) ? 1 : -1;
        const int down = v + 1 < height_px && body(u, v + 1) == body(u, v) ? 1 : -1;
        const int u1 = std::clamp(u + right, 0, width_px - 1);
        const int v1 = std::clamp(v + down, 0, height_px - 1);
        const Vector3d normal =
            (point(u1, v) - point(u, v)).cross(point(u, v1) - point(u, v)).normalized() * (right * down);
        const double facing = std::abs(normal.dot(ray(u, v).normalized()));
        const double light = kAmbient + (1 - kAmbient) * (std::isfinite(facing) ? facing : 1.0);
        const report::Colour plain = colour_of(cell.bodies[body(u, v)]);
        colour = {plain.red * light, plain.green * light, plain.blue * light};
      }
      raster.set(u, v, mixed(colour, report::kGrayArea, through(haze, ray_world, depth_m)));
    }
  }
  return raster;
}

report::CanvasPoint CellView::at(const Vector3d& p_world) const noexcept {
  const DepthPoint p = project(camera_, T_world_camera_.inverse(Eigen::Isometry) * p_world);
  return {p.x_px, p.y_px};
}

}  // namespace depthgrid::experiments
