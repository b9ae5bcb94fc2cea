#include "lab/day/running_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::lab {
namespace {

using simulation::BodyKind;
using simulation::nearest_point;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// What numbers written with six digits, of positions and times, may be off by.
constexpr double kRounding_m = 2e-5;
/// Between the points that a solid's surface is sampled at.
constexpr double kSample_m = 0.02;

Eigen::Vector3d clamped(const views::BoxSpace& space, const Eigen::Vector3d& p) {
  return p.cwiseMax(space.low_world).cwiseMin(space.high_world);
}

/// Least of a convex function on [0, 1], by the golden section; where it is.
template <class Function>
double least_at(const Function& f) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 36;
  double low = 0;
  double high = 1;
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double fa = f(a);
  double fb = f(b);
  for (int n = 0; n < kSteps; ++n) {
    if (fa <= fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - kGolden * (high - low);
      fa = f(a);
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + kGolden * (high - low);
      fb = f(b);
    }
  }
  double best = 0.5 * (low + high);
  for (const double end : {0.0, 1.0}) {
    best = f(end) < f(best) ? end : best;
  }
  return best;
}

Eigen::Vector3d on(const Capsule& capsule, double at) { return capsule.a + at * (capsule.b - capsule.a); }

/// From a capsule's surface to all of a solid.
template <class Shape>
double whole_distance_m(const Capsule& part, const Shape& shape) {
  const auto from = [&](double at) { return (nearest_point(shape, on(part, at)) - on(part, at)).norm(); };
  return from(least_at(from)) - part.radius_m;
}

/// The point of solid and space that is nearest to p (Dykstra's projections); nothing where they have none in common.
template <class Shape>
std::optional<Eigen::Vector3d> nearest_within(const Shape& shape, const views::BoxSpace& space,
                                              const Eigen::Vector3d& p) {
  constexpr int kSteps = 200;
  constexpr double kClose_m = 1e-9;
  constexpr double kApart_m = 1e-4;
  Eigen::Vector3d x = p;
  Eigen::Vector3d of_shape = Eigen::Vector3d::Zero();
  Eigen::Vector3d of_space = Eigen::Vector3d::Zero();
  for (int n = 0; n < kSteps; ++n) {
    const Eigen::Vector3d y = nearest_point(shape, x + of_shape);
    of_shape = x + of_shape - y;
    const Eigen::Vector3d next = clamped(space, y + of_space);
    of_space = y + of_space - next;
    const bool is_there = (next - x).norm() < kClose_m && (next - y).norm() < kClose_m;
    x = next;
    if (is_there) {
      break;
    }
  }
  return (nearest_point(shape, x) - x).norm() < kApart_m ? std::optional(x) : std::nullopt;
}

struct NearestInSpace {
  double distance_m = kInfinite;
  Eigen::Vector3d at_world = Eigen::Vector3d::Zero();
};

/// From a capsule's surface to what of a solid is in the space.
template <class Shape>
NearestInSpace nearest_in_space(const Capsule& part, const Shape& shape, const views::BoxSpace& space) {
  // Mostly the nearest point of all of it lies within.
  const auto from_all = [&](double at) { return (nearest_point(shape, on(part, at)) - on(part, at)).norm(); };
  const double at_all = least_at(from_all);
  const Eigen::Vector3d of_all = nearest_point(shape, on(part, at_all));
  if (clamped(space, of_all) == of_all) {
    return {(of_all - on(part, at_all)).norm() - part.radius_m, of_all};
  }
  const auto from = [&](double at) {
    const auto x = nearest_within(shape, space, on(part, at));
    return x ? (*x - on(part, at)).norm() : kInfinite;
  };
  const double at = least_at(from);
  const auto x = nearest_within(shape, space, on(part, at));
  return x ? NearestInSpace{(*x - on(part, at)).norm() - part.radius_m, *x} : NearestInSpace{};
}

// Points of surfaces, some centimetres apart.

std::vector<Eigen::Vector3d> sampled(const Capsule& capsule) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Vector3d axis = capsule.b - capsule.a;
  const Eigen::Vector3d w = axis.norm() > 0 ? axis.normalized() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d u = w.unitOrthogonal();
  const Eigen::Vector3d v = w.cross(u);
  const int around = std::max(8, static_cast<int>(2 * std::numbers::pi * capsule.radius_m / kSample_m));
  const auto ring = [&](const Eigen::Vector3d& centre, double radius_m) {
    for (int n = 0; n < around; ++n) {
      const double angle = 2 * std::numbers::pi * n / around;
      points.emplace_back(centre + radius_m * (std::cos(angle) * u + std::sin(angle) * v));
    }
  };
  const int along = std::max(1, static_cast<int>(axis.norm() / kSample_m));
  for (int n = 0; n <= along; ++n) {
    ring(on(capsule, static_cast<double>(n) / along), capsule.radius_m);
  }
  const int up = std::max(3, around / 4);
  for (int n = 1; n <= up; ++n) {
    const double angle = 0.5 * std::numbers::pi * n / up;
    const double radius_m = capsule.radius_m * std::cos(angle);
    ring(capsule.b + capsule.radius_m * std::sin(angle) * w, radius_m);
    ring(capsule.a - capsule.radius_m * std::sin(angle) * w, radius_m);
  }
  return points;
}

std::vector<Eigen::Vector3d> sampled(const simulation::Box& box) {
  std::vector<Eigen::Vector3d> points;
  for (int axis = 0; axis < 3; ++axis) {
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    const int nb = std::max(1, static_cast<int>(2 * box.half_size_m[b] / kSample_m));
    const int nc = std::max(1, static_cast<int>(2 * box.half_size_m[c] / kSample_m));
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i <= nb; ++i) {
        for (int j = 0; j <= nc; ++j) {
          Eigen::Vector3d p;
          p[axis] = side * box.half_size_m[axis];
          p[b] = box.half_size_m[b] * (2.0 * i / nb - 1);
          p[c] = box.half_size_m[c] * (2.0 * j / nc - 1);
          points.emplace_back(box.T_world_box * p);
        }
      }
    }
  }
  return points;
}

// The floor and the walls of the simulated room lie outside of any sensible space; their nearest point is enough.
std::vector<Eigen::Vector3d> sampled(const simulation::Plane& /*plane*/) { return {}; }
std::vector<Eigen::Vector3d> sampled(const simulation::Sphere& sphere) {
  return sampled(Capsule::sphere(sphere.centre_world, sphere.radius_m));
}

double distance_to_m(const std::vector<Capsule>& robot, const Eigen::Vector3d& p) {
  double least_m = kInfinite;
  for (const Capsule& link : robot) {
    least_m = std::min(least_m, distance_to_axis(link, p) - link.radius_m);
  }
  return least_m;
}

/// Whether something of the robot, grown by so much, is between.
bool is_hidden(const std::vector<Capsule>& robot, double grown_m, const Eigen::Vector3d& from,
               const Eigen::Vector3d& to) {
  return std::any_of(robot.begin(), robot.end(), [&](const Capsule& link) {
    const auto apart = [&](double at) { return distance_to_axis(link, from + at * (to - from)); };
    return apart(least_at(apart)) <= link.radius_m + grown_m;
  });
}

/// What an answer does not speak of, at the images it stands on.
struct Unclaimed {
  const std::vector<UsedImage>& images;
  std::vector<std::vector<Capsule>> robots;  ///< one an image
  const std::vector<Eigen::Vector3d>& cameras_world;
  double time_s;
  double blind_m;
  double pocket_m;
  double v_max_m_s;

  [[nodiscard]] bool has(const Eigen::Vector3d& p) const {
    for (std::size_t i = 0; i < images.size(); ++i) {
      const double layer_m = blind_m + v_max_m_s * std::max(0.0, time_s - images[i].time_s);
      const double apart_m = distance_to_m(robots[i], p);
      // What one camera's robot pixels free is free, whatever another sees there.
      if (apart_m <= layer_m ||
          (apart_m <= layer_m + pocket_m && is_hidden(robots[i], layer_m, cameras_world[images[i].camera], p))) {
        return true;
      }
    }
    return false;
  }
};

/// Planes last: they are far, and what they share with the space takes longest to find.
template <class Visit>
void for_each_solid(const simulation::Workcell& cell, const Visit& visit) {
  for (const simulation::WorkcellBody& body : cell.bodies) {
    if (body.kind != BodyKind::robot) {
      std::for_each(body.boxes.begin(), body.boxes.end(), visit);
      std::for_each(body.spheres.begin(), body.spheres.end(), visit);
      std::for_each(body.capsules.begin(), body.capsules.end(), visit);
    }
  }
  for (const simulation::WorkcellBody& body : cell.bodies) {
    if (body.kind != BodyKind::robot) {
      std::for_each(body.planes.begin(), body.planes.end(), visit);
    }
  }
}

}  // namespace

RunningTruth::RunningTruth(const cell::Cell& cell, const cell::CellSetup& setup,
                           std::shared_ptr<const sensors::SimulatedCell> simulated)
    : space_(cell.space),
      pocket_m_(cell.policies.ignored_pocket_m),
      v_max_m_s_(cell.v_max_m_s),
      robot_(setup.robot),
      parts_(setup.parts),
      simulated_(std::move(simulated)) {
  if (robot_) {
    links_ = robot::link_capsules(robot_->model);
  }
  for (const RigCamera& camera : setup.rig.cameras) {
    cameras_world_.emplace_back(camera.T_world_camera.translation());
  }
}

std::vector<Capsule> RunningTruth::robot_at(double time_s) const {
  std::vector<Capsule> robot(links_.size());
  if (robot_) {
    std::vector<double> q(simulated_->joints());
    simulated_->joints_at(time_s, q);
    robot::place(links_, robot_->link_poses(q), robot);
  }
  return robot;
}

void RunningTruth::go_to(double time_s) {
  if (time_s == at_s_) {
    return;
  }
  at_s_ = time_s;
  bodies_ = simulated_->bodies_at(time_s);
  for (simulation::WorkcellBody& body : bodies_.bodies) {
    body = simulation::in_world(body);
  }
  parts_world_.clear();
  std::vector<Pose> T_world_link;
  if (robot_) {
    std::vector<double> q(simulated_->joints());
    simulated_->joints_at(time_s, q);
    T_world_link = robot_->link_poses(q);
  }
  for (const cell::AskedPart& part : parts_) {
    Capsule& placed = parts_world_.emplace_back(part.at_world);
    if (part.on_robot) {
      robot::place({&*part.on_robot, 1}, T_world_link, {&placed, 1});
    }
  }
}

double RunningTruth::distance_m(std::size_t part, double time_s) {
  go_to(time_s);
  double least_m = kInfinite;
  for_each_solid(bodies_, [&](const auto& shape) {
    if (whole_distance_m(parts_world_.at(part), shape) < least_m) {
      least_m = std::min(least_m, nearest_in_space(parts_world_.at(part), shape, space_).distance_m);
    }
  });
  return std::max(0.0, least_m);
}

std::optional<double> RunningTruth::excess_m(std::size_t part, double time_s, double said_m, double blind_m,
                                             const std::vector<UsedImage>& images) {
  go_to(time_s);
  const Capsule& capsule = parts_world_.at(part);
  const Capsule middle =
      Capsule::sphere(0.5 * (capsule.a + capsule.b), capsule.radius_m + 0.5 * (capsule.b - capsule.a).norm());
  const double limit_m = said_m - kRounding_m;
  std::optional<Unclaimed> unclaimed;
  double excess_m = 0;
  bool is_nearer = false;
  for_each_solid(bodies_, [&](const auto& shape) {
    // Most solids are far off, which two quick looks show.
    const double at_least_m = (nearest_point(shape, middle.a) - middle.a).norm() - middle.radius_m;
    if (at_least_m >= limit_m || whole_distance_m(capsule, shape) >= limit_m) {
      return;
    }
    const NearestInSpace nearest = nearest_in_space(capsule, shape, space_);
    if (!(nearest.distance_m < limit_m)) {
      return;
    }
    is_nearer = true;
    if (!unclaimed) {
      unclaimed.emplace(Unclaimed{images, {}, cameras_world_, time_s, blind_m, pocket_m_, v_max_m_s_});
      for (const UsedImage& image : images) {
        unclaimed->robots.push_back(robot_at(image.time_s));
      }
    }
    const auto look_at = [&](const Eigen::Vector3d& p) {
      const double apart_m = std::max(0.0, distance_to_axis(capsule, p) - capsule.radius_m);
      if (apart_m < said_m - std::max(excess_m, kRounding_m) && !unclaimed->has(p)) {
        excess_m = said_m - apart_m;
      }
    };
    look_at(nearest.at_world);
    for (const Eigen::Vector3d& p : sampled(shape)) {
      if (clamped(space_, p) == p) {
        look_at(p);
      }
    }
  });
  unclaimed_ += is_nearer && !(excess_m > 0) ? 1 : 0;
  return excess_m > 0 ? std::optional(excess_m) : std::nullopt;
}

}  // namespace depthgrid::lab
