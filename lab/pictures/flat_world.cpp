#include "lab/pictures/flat_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace depthgrid::lab {

using Eigen::Vector2d;

double distance_m(const FlatSolid& solid, const Vector2d& p) {
  const Vector2d along = solid.to - solid.from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - solid.from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - solid.from - share * along).norm() - solid.radius_m;
}

double distance_m(std::span<const FlatSolid> solids, const Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const FlatSolid& solid : solids) {
    least = std::min(least, distance_m(solid, p));
  }
  return least;
}

FlatView::FlatView(const FlatCamera& camera, std::span<const FlatSolid> solids, double margin_m, int filter_px,
                   std::span<const FlatSolid> padded_robot)
    : camera_(camera) {
  constexpr double kStep = 0.001;
  for (int pixel = 0; pixel < camera_.pixels; ++pixel) {
    double depth = camera_.near_m;
    while (depth < camera_.far_m && distance_m(solids, deproject(pixel + 0.5, depth)) > 0) {
      depth += kStep;
    }
    read_m_.push_back(std::min(depth, camera_.far_m));
    if (depth < camera_.far_m && distance_m(padded_robot, deproject(pixel + 0.5, depth)) <= 0) {
      while (distance_m(padded_robot, deproject(pixel + 0.5, depth)) <= 0) {
        depth += kStep;  // the robot's exit
      }
    } else {
      depth = read_m_.back() - margin_m;
    }
    free_m_.push_back(depth);
  }
  const std::vector<double> each = free_m_;
  for (int pixel = 0; pixel < camera_.pixels; ++pixel) {
    const auto first = each.begin() + std::max(0, pixel - filter_px);
    const auto last = each.begin() + std::min(camera_.pixels, pixel + filter_px + 1);
    free_m_[static_cast<std::size_t>(pixel)] = *std::min_element(first, last);
  }
}

Vector2d FlatView::project(const Vector2d& p) const {
  const Vector2d side(-camera_.axis.y(), camera_.axis.x());
  const double depth_m = (p - camera_.place).dot(camera_.axis);
  const double focal_px = 0.5 * camera_.pixels / std::tan(camera_.half_angle_rad);
  return {focal_px * (p - camera_.place).dot(side) / depth_m + 0.5 * camera_.pixels, depth_m};
}

Vector2d FlatView::deproject(double pixel, double depth_m) const {
  const Vector2d side(-camera_.axis.y(), camera_.axis.x());
  const double focal_px = 0.5 * camera_.pixels / std::tan(camera_.half_angle_rad);
  return camera_.place + depth_m * (camera_.axis + (pixel - 0.5 * camera_.pixels) / focal_px * side);
}

bool FlatView::looks_at(const Vector2d& p) const {
  const Vector2d seen = project(p);
  return seen.y() > camera_.near_m && seen.x() >= 0 && seen.x() < camera_.pixels;
}

bool FlatView::frees(const Vector2d& p) const {
  const Vector2d seen = project(p);
  return looks_at(p) && seen.y() < free_m_[static_cast<std::size_t>(seen.x())];
}

bool FlatView::frees(const Vector2d& p, double radius_m) const {
  constexpr int kDirections = 32;
  bool free = frees(p);
  for (int i = 0; free && radius_m > 0 && i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    free = frees(p + radius_m * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return free;
}

}  // namespace depthgrid::lab
