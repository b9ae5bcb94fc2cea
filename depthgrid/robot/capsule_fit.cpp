#include "depthgrid/robot/capsule_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

namespace {

using Eigen::Vector3d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double volume(const Capsule& c) {
  return std::numbers::pi * c.radius_m * c.radius_m * ((c.b - c.a).norm() + 4.0 / 3.0 * c.radius_m);
}

/// Where the search stands: the axis' direction as a turn of the start's, its offset across, and how much wider than
/// needed the capsule is (a wider one may be shorter).
using Parameters = std::array<double, 5>;

/// The capsule of these parameters that just contains the points.
class Family {
 public:
  Family(const Eigen::ArrayX3d& points, Vector3d centre, Vector3d direction)
      : points_(points),
        square_(points.rows()),
        along_(points.rows()),
        centre_(std::move(centre)),
        z_(std::move(direction)),
        x_(z_.unitOrthogonal()),
        y_(z_.cross(x_)) {}

  [[nodiscard]] Capsule operator()(const Parameters& p) {
    const Vector3d along = (z_ + p[0] * x_ + p[1] * y_).normalized();
    const Vector3d origin = centre_ + p[2] * x_ + p[3] * y_;
    project(origin, along);
    const double radius_m = std::sqrt(square_.maxCoeff()) * (1 + p[4] * p[4]);
    square_ = (radius_m * radius_m - square_).max(0.0).sqrt();  // how far the round end reaches beyond its centre
    double low_m = (along_ + square_).minCoeff();
    double high_m = (along_ - square_).maxCoeff();
    if (low_m > high_m) {  // one ball holds them all
      low_m = high_m = 0.5 * (low_m + high_m);
    }
    return {origin + low_m * along, origin + high_m * along, radius_m};
  }

 private:
  /// Of each point the square of its distance from the axis, and its place along it.
  void project(const Vector3d& origin, const Vector3d& axis) {
    const auto dx = points_.col(0) - origin.x();
    const auto dy = points_.col(1) - origin.y();
    const auto dz = points_.col(2) - origin.z();
    square_ = (dy * axis.z() - dz * axis.y()).square() + (dz * axis.x() - dx * axis.z()).square() +
              (dx * axis.y() - dy * axis.x()).square();
    along_ = dx * axis.x() + dy * axis.y() + dz * axis.z();
  }

  const Eigen::ArrayX3d& points_;
  Eigen::ArrayXd square_, along_;
  Vector3d centre_, z_, x_, y_;
};

/// Walks along the parameters one by one as long as the volume falls, then with half the steps.
Capsule descend(Family family, double size_m) {
  Parameters at{};
  double least = volume(family(at));
  constexpr int kHalvings = 15;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double step = std::ldexp(0.3, -halving);
    for (bool better = true; better;) {
      better = false;
      for (std::size_t i = 0; i < at.size(); ++i) {
        for (const double sign : {1.0, -1.0}) {
          Parameters tried = at;
          tried[i] += sign * step * (i == 2 || i == 3 ? size_m : 1.0);
          const double value = volume(family(tried));
          if (value < least * (1 - 1e-9)) {
            least = value;
            at = tried;
            better = true;
          }
        }
      }
    }
  }
  return family(at);
}

/// Points that lie together in a file, mostly also in space.
struct Block {
  std::span<const Vector3d> points;
  Eigen::AlignedBox3d box;

  /// Not below the same product with any of the points, rounding included.
  [[nodiscard]] double farthest(const Vector3d& direction) const {
    return Vector3d((direction.array() > 0).select(box.max(), box.min())).dot(direction);
  }
};

std::vector<Block> blocks_of(std::span<const Vector3d> points) {
  constexpr std::size_t kSize = 64;
  std::vector<Block> result;
  for (std::size_t begin = 0; begin < points.size(); begin += kSize) {
    result.push_back({points.subspan(begin, std::min(kSize, points.size() - begin)), {}});
    for (const Vector3d& point : result.back().points) {
      result.back().box.extend(point);
    }
  }
  return result;
}

/// The first of the points that are farthest in a direction. `bounds` is room for a number a block.
const Vector3d* farthest_of(const std::vector<Block>& blocks, const Vector3d& direction, std::vector<double>& bounds) {
  std::transform(blocks.begin(), blocks.end(), bounds.begin(),
                 [&direction](const Block& block) { return block.farthest(direction); });
  const auto promising = static_cast<std::size_t>(std::max_element(bounds.begin(), bounds.end()) - bounds.begin());
  double least = -kInfinity;
  for (const Vector3d& point : blocks[promising].points) {
    least = std::max(least, point.dot(direction));
  }
  const Vector3d* result = &blocks.front().points.front();
  double most = -kInfinity;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (bounds[i] < least) {
      continue;
    }
    for (const Vector3d& point : blocks[i].points) {
      if (const double value = point.dot(direction); value > most) {
        most = value;
        result = &point;
      }
    }
  }
  return result;
}

/// The outermost points in many directions: all that matters, nearly, for a search over many points.
std::vector<Vector3d> outermost(std::span<const Vector3d> points) {
  constexpr int kDirections = 300;
  const std::vector<Block> blocks = blocks_of(points);
  std::vector<double> bounds(blocks.size());
  std::vector<Vector3d> result;
  for (int i = 0; i < kDirections; ++i) {  // evenly over the sphere, on a spiral
    const double z = 1 - (2 * i + 1.0) / kDirections;
    const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double across = std::sqrt(1 - z * z);
    const Vector3d direction(across * std::cos(turn), across * std::sin(turn), z);
    const Vector3d* const farthest = farthest_of(blocks, direction, bounds);
    if (std::find(result.begin(), result.end(), *farthest) == result.end()) {
      result.push_back(*farthest);
    }
  }
  return result;
}

std::vector<Vector3d> start_directions(std::span<const Vector3d> points, const Vector3d& centre) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& point : points) {
    spread += (point - centre) * (point - centre).transpose();
  }
  const Eigen::Matrix3d main = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  std::vector<Vector3d> directions{main.col(0), main.col(1), main.col(2)};
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      directions.push_back(Vector3d(x, y, 1).normalized());
    }
  }
  return directions;
}

}  // namespace

Capsule fit_capsule(std::span<const Vector3d> points) {
  if (points.empty()) {
    fail("capsule fit: there are no points");
  }
  for (const Vector3d& point : points) {
    if (!point.allFinite()) {
      fail("capsule fit: a point is (", point.transpose(), "), must be finite");
    }
  }
  const std::vector<Vector3d> outer = outermost(points);
  Vector3d low = outer[0];
  Vector3d high = outer[0];
  for (const Vector3d& point : outer) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Vector3d centre = 0.5 * (low + high);
  Eigen::ArrayX3d columns(static_cast<Eigen::Index>(outer.size()), 3);
  for (std::size_t i = 0; i < outer.size(); ++i) {
    columns.row(static_cast<Eigen::Index>(i)) = outer[i].transpose();
  }
  Capsule best{centre, centre, kInfinity};
  for (const Vector3d& direction : start_directions(outer, centre)) {
    const Capsule found = descend(Family(columns, centre, direction), (high - low).norm());
    best = volume(found) < volume(best) || !std::isfinite(best.radius_m) ? found : best;
  }
  double radius_m = 0;
  for (const Vector3d& point : points) {
    radius_m = std::max(radius_m, distance_to_axis(best, point));
  }
  best.radius_m = radius_m * (1 + 1e-12);
  return best;
}

Capsule around(const CylinderShape& cylinder) {
  // With half axis s the rim is contained from radius sqrt(r^2 + (h - s)^2) on; the volume has one minimum.
  const double h = 0.5 * cylinder.length_m;
  const auto at = [&](double s) {
    return Capsule{{0, 0, -s}, {0, 0, s}, std::hypot(cylinder.radius_m, h - s) * (1 + 1e-12)};
  };
  Capsule best = at(h);
  constexpr int kSteps = 200;
  for (int i = 0; i < kSteps; ++i) {
    const Capsule tried = at(h * i / kSteps);
    best = volume(tried) < volume(best) ? tried : best;
  }
  return best;
}

std::vector<Capsule> around(const BoxShape& box) {
  constexpr double kMaxCount = 8;
  int longest = 0;
  int shortest = 0;
  box.size_m.maxCoeff(&longest);
  box.size_m.minCoeff(&shortest);
  if (longest == shortest) {  // a cube
    shortest = (longest + 1) % 3;
  }
  const int across = 3 - longest - shortest;
  const double ratio = box.size_m[across] / std::max(box.size_m[shortest], std::numeric_limits<double>::min());
  const int count = static_cast<int>(std::clamp(std::round(ratio), 1.0, kMaxCount));
  const double width_m = box.size_m[across] / count;
  const Capsule one = around(CylinderShape{0.5 * std::hypot(width_m, box.size_m[shortest]), box.size_m[longest]});
  std::vector<Capsule> result;
  for (int i = 0; i < count; ++i) {
    Vector3d centre = Vector3d::Zero();
    centre[across] = (i + 0.5) * width_m - 0.5 * box.size_m[across];
    result.push_back(
        {centre + one.a.z() * Vector3d::Unit(longest), centre + one.b.z() * Vector3d::Unit(longest), one.radius_m});
  }
  return result;
}

}  // namespace depthgrid::robot
