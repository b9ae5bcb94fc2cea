// Random solids and an independent description of them: signed distances, written without the library's formulas.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/simulation/scene.hpp"
#include "support/random_run.hpp"

namespace depthgrid::simulation::testing {

/// Every case has the seed `seed() + case number`, so a printed seed repeats a case.
inline unsigned long seed() { return test::random_run(1).seed; }

inline int count(int standard) { return static_cast<int>(test::random_run(standard).count); }

/// Negative inside, metres; exact outside.
using SignedDistance = std::function<double(const Eigen::Vector3d&)>;

/// A solid, its outside description (grown by a padding) and a line of code that rebuilds it.
struct Solid {
  std::function<void(Scene&, Body)> add;
  std::function<SignedDistance(double padding_m)> grown;
  std::function<Interval(const Line&)> intersect;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> nearest;
  std::function<bool(const Eigen::Vector3d&)> contains;
  std::string text;
};

template <class Shape>
Solid make_solid(const Shape& shape, std::function<SignedDistance(double)> grown, std::string text) {
  return {[shape](Scene& scene, Body body) { scene.add(shape, body); },
          std::move(grown),
          [shape](const Line& line) { return simulation::intersect(shape, line); },
          [shape](const Eigen::Vector3d& p) { return simulation::nearest_point(shape, p); },
          [shape](const Eigen::Vector3d& p) { return simulation::contains(shape, p); },
          std::move(text)};
}

inline std::string code(const Eigen::Vector3d& v) {
  std::ostringstream text;
  text << std::setprecision(17) << "{" << v.x() << ", " << v.y() << ", " << v.z() << "}";
  return text.str();
}

inline Solid describe(const Plane& s) {
  return make_solid(
      s, [s](double pad) { return [s, pad](const Eigen::Vector3d& p) { return s.normal.dot(p) - s.offset_m - pad; }; },
      "Plane{" + code(s.normal) + ", " + std::to_string(s.offset_m) + "}");
}

inline Solid describe(const Box& s) {
  return make_solid(
      s,
      [s](double pad) {
        return [s, pad](const Eigen::Vector3d& p) {
          Eigen::Vector3d excess;
          for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3d direction = s.T_world_box.linear().col(axis);
            excess[axis] =
                std::abs(direction.dot(p - s.T_world_box.translation())) - std::abs(s.half_size_m[axis]) - pad;
          }
          return excess.cwiseMax(0.0).norm() + std::min(excess.maxCoeff(), 0.0);
        };
      },
      "Box at " + code(s.T_world_box.translation()) + " half " + code(s.half_size_m) + " axes " +
          code(s.T_world_box.linear().col(0)) + code(s.T_world_box.linear().col(1)));
}

inline Solid describe(const Sphere& s) {
  return make_solid(
      s,
      [s](double pad) {
        return [s, pad](const Eigen::Vector3d& p) { return (p - s.centre_world).norm() - s.radius_m - pad; };
      },
      "Sphere{" + code(s.centre_world) + ", " + std::to_string(s.radius_m) + "}");
}

inline Solid describe(const Capsule& s) {
  return make_solid(
      s,
      [s](double pad) {
        return [s, pad](const Eigen::Vector3d& p) {
          // Distance to a segment: to the infinite line where the foot lies between the ends, else to the nearer end.
          const Eigen::Vector3d ab = s.b - s.a;
          double to_axis = std::min((p - s.a).norm(), (p - s.b).norm());
          if (ab.dot(p - s.a) > 0 && ab.dot(p - s.b) < 0) {
            to_axis = ab.cross(p - s.a).norm() / ab.norm();
          }
          return to_axis - s.radius_m - pad;
        };
      },
      "Capsule{" + code(s.a) + ", " + code(s.b) + ", " + std::to_string(s.radius_m) + "}");
}

class Random {
 public:
  explicit Random(unsigned long seed) : engine_(seed) {}
  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(engine_); }
  int integer(int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(engine_); }
  Eigen::Vector3d in_cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Eigen::Vector3d unit() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  Pose pose(double half) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(uniform(0, 3.1), unit()).toRotationMatrix();
    pose.translation() = in_cube(half);
    return pose;
  }
  /// Any of the four solids within about 2 m of the origin, slender and fat ones, now and then axis-parallel.
  Solid solid() {
    const bool aligned = integer(0, 3) == 0;
    switch (integer(0, 6)) {
      case 0:
        return describe(Plane{aligned ? Eigen::Vector3d::UnitZ() : unit(), uniform(-2.5, -1.0)});
      case 1:
      case 2: {
        Box box{pose(1.5), {uniform(0.01, 0.6), uniform(0.01, 0.6), uniform(0.01, 0.6)}};
        if (aligned) {
          box.T_world_box.linear().setIdentity();
        }
        return describe(box);
      }
      case 3:
        return describe(Sphere{in_cube(1.5), uniform(0.01, 0.6)});
      default: {
        const Eigen::Vector3d a = in_cube(1.5);
        const double length = integer(0, 5) == 0 ? 0.0 : uniform(0.0, 1.2);
        return describe(Capsule{a, a + length * (aligned ? Eigen::Vector3d(Eigen::Vector3d::UnitX()) : unit()),
                                uniform(0.01, 0.3)});
      }
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace depthgrid::simulation::testing
