// Distances between bodies against closed forms, and against minimisation along segments where there is none.
#include "lab/workcell/cell_truth.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "depthgrid/core/error.hpp"
#include "simulation/random_scenes.hpp"

namespace depthgrid::workcell::testing {
namespace {

using simulation::BodyKind;
using simulation::Box;
using simulation::mesh_of;
using simulation::nearest_point;
using simulation::Plane;
using simulation::Sphere;
using simulation::transformed;
using simulation::TriangleMesh;
using simulation::Workcell;
using simulation::WorkcellBody;
using simulation::testing::count;
using simulation::testing::Random;
using simulation::testing::seed;

constexpr double kTolerance = 1e-5;

WorkcellBody body(const std::string& name, BodyKind kind) {
  WorkcellBody result;
  result.name = name;
  result.kind = kind;
  return result;
}

/// The least value of a convex function on [0, 1].
template <class Function>
double least(const Function& f) {
  double lower = 0;
  double upper = 1;
  for (int i = 0; i < 200; ++i) {
    const double a = lower + (upper - lower) / 3;
    const double b = upper - (upper - lower) / 3;
    (f(a) < f(b) ? upper : lower) = f(a) < f(b) ? b : a;
  }
  return f(0.5 * (lower + upper));
}

Eigen::Vector3d on_axis(const Capsule& capsule, double share) { return capsule.a + share * (capsule.b - capsule.a); }

/// Distance of two convex solids, one of them a capsule: that of its axis, point by point, less its radius.
template <class Shape>
double expected(const Capsule& capsule, const Shape& shape) {
  const double axis_m = least([&](double share) {
    const Eigen::Vector3d p = on_axis(capsule, share);
    return (nearest_point(shape, p) - p).norm();
  });
  return std::max(0.0, axis_m - capsule.radius_m);
}

Capsule random_capsule(Random& random) {
  const Eigen::Vector3d a = random.in_cube(1);
  const double length_m = random.integer(0, 5) == 0 ? 0 : random.uniform(0.01, 1);
  return {a, a + length_m * random.unit(), random.uniform(0.02, 0.3)};
}

/// Distance found, and its points checked: each on its body, and as far apart as said.
template <class First, class Second>
double found(const First& first, const Second& second, const Workcell& cell, const std::string& where) {
  const CellTruth truth(cell);
  const std::optional<BodyDistance> answer = truth.between(0, 1);
  EXPECT_TRUE(answer.has_value()) << where;
  if (answer->distance_m > 0) {
    EXPECT_NEAR((answer->on_first_world - answer->on_second_world).norm(), answer->distance_m, kTolerance) << where;
    EXPECT_LT((nearest_point(first, answer->on_first_world) - answer->on_first_world).norm(), kTolerance) << where;
    EXPECT_LT((nearest_point(second, answer->on_second_world) - answer->on_second_world).norm(), kTolerance) << where;
  } else {
    EXPECT_TRUE(answer->on_first_world.hasNaN()) << where;
  }
  return answer->distance_m;
}

TEST(CellTruth, CapsulesAgainstEverySolid) {
  double worst_m = 0;
  int overlaps = 0;
  for (int n = 0; n < count(2000); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n));
    Workcell cell;
    cell.bodies = {body("link", BodyKind::robot), body("other", BodyKind::person)};
    const Pose T_world_link = random.pose(1);
    const Capsule link = random_capsule(random);
    cell.bodies[0].T_world_body = T_world_link;
    cell.bodies[0].capsules = {transformed(T_world_link.inverse(), link)};
    const auto check = [&](const auto& other) {
      const double right_m = expected(link, other);
      const double found_m = found(link, other, cell, where);
      ASSERT_NEAR(found_m, right_m, kTolerance) << where;
      worst_m = std::max(worst_m, std::abs(found_m - right_m));
      overlaps += right_m == 0 ? 1 : 0;
    };
    WorkcellBody& other = cell.bodies[1];
    switch (n % 4) {
      case 0:
        other.capsules = {random_capsule(random)};
        check(other.capsules[0]);
        break;
      case 1:
        other.boxes = {Box{random.pose(1), {random.uniform(0.02, 0.5), 0.2, random.uniform(0.02, 0.5)}}};
        check(other.boxes[0]);
        break;
      case 2:
        other.spheres = {Sphere{random.in_cube(1), random.uniform(0.02, 0.4)}};
        check(other.spheres[0]);
        break;
      default:
        other.planes = {Plane{random.unit(), random.uniform(-1.5, 0)}};
        check(other.planes[0]);
    }
  }
  std::printf("[ figures  ] off by %.1e m at most, %d of the pairs overlap\n", worst_m, overlaps);
  EXPECT_GT(overlaps, 0);
}

TEST(CellTruth, SpheresBoxesAndPlanesByClosedForm) {
  for (int n = 0; n < count(1000); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n));
    const Box box{random.pose(1), {random.uniform(0.02, 0.5), 0.2, random.uniform(0.02, 0.5)}};
    const Sphere ball{random.in_cube(1.5), random.uniform(0.02, 0.4)};
    const Plane floor{random.unit(), -1};
    Workcell cell;
    cell.bodies = {body("box", BodyKind::object), body("ball", BodyKind::person)};
    cell.bodies[0].boxes = {box};
    cell.bodies[1].spheres = {ball};
    const double to_box_m = (nearest_point(box, ball.centre_world) - ball.centre_world).norm() - ball.radius_m;
    ASSERT_NEAR(found(box, ball, cell, where), std::max(0.0, to_box_m), kTolerance) << where;

    cell.bodies[1] = body("floor", BodyKind::room);
    cell.bodies[1].planes = {floor};
    double lowest_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3f& corner : mesh_of(box).vertices_m) {
      lowest_m = std::min(lowest_m, floor.normal.dot(corner.cast<double>()) - floor.offset_m);
    }
    ASSERT_NEAR(found(box, floor, cell, where), std::max(0.0, lowest_m), kTolerance) << where;
  }
}

TEST(CellTruth, MeshesAreAsFarAsTheSolidsTheyAreMadeOf) {
  constexpr int kSegments = 48;
  double worst_m = 0;
  for (int n = 0; n < count(60); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n));
    const Capsule link = random_capsule(random);
    const Capsule arm = random_capsule(random);
    const Pose T_world_link = random.pose(1);
    Workcell cell;
    cell.bodies = {body("link", BodyKind::robot), body("arm", BodyKind::person)};
    cell.bodies[0].mesh = std::make_shared<TriangleMesh>(mesh_of(link, kSegments));
    cell.bodies[1].capsules = {arm};
    CellTruth truth(cell);
    cell.bodies[0].T_world_body = T_world_link;  // moved after the mesh was taken over
    truth.update(cell);
    const double right_m = expected(arm, transformed(T_world_link, link));
    if (right_m <= 0) {
      continue;
    }
    const double found_m = truth.between(0, 1)->distance_m;
    ASSERT_GT(found_m, right_m - kTolerance) << where;
    ASSERT_LT(found_m, right_m + simulation::inscribed_depth_m(link.radius_m, kSegments) + kTolerance) << where;
    worst_m = std::max(worst_m, found_m - right_m);
  }
  EXPECT_GT(worst_m, 0) << "no pair was apart: nothing tested";
}

TEST(CellTruth, TheNearestPairIsTheLeastOfAllPairs) {
  for (int n = 0; n < count(30); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    Workcell cell;
    for (int i = 0; i < 8; ++i) {
      const BodyKind kind = i < 4 ? BodyKind::robot : i < 6 ? BodyKind::person : BodyKind::object;
      cell.bodies.push_back(body("body " + std::to_string(i), kind));
      cell.bodies.back().T_world_body = random.pose(0.5);
      cell.bodies.back().capsules = {random_capsule(random), random_capsule(random)};
      cell.bodies.back().capsules[0].radius_m = cell.bodies.back().capsules[1].radius_m = 0.02;
    }
    const CellTruth truth(cell);
    double people_m = std::numeric_limits<double>::infinity();
    double all_m = people_m;
    for (std::size_t i = 0; i < 4; ++i) {
      double from_link_m = std::numeric_limits<double>::infinity();
      for (std::size_t j = 4; j < 8; ++j) {
        const double pair_m = truth.between(i, j)->distance_m;
        from_link_m = std::min(from_link_m, pair_m);
        people_m = j < 6 ? std::min(people_m, pair_m) : people_m;
      }
      EXPECT_EQ(truth.nearest(i, {BodyKind::person, BodyKind::object})->distance_m, from_link_m);
      all_m = std::min(all_m, from_link_m);
    }
    EXPECT_EQ(truth.nearest(BodyKind::robot, {BodyKind::person})->distance_m, people_m);
    const BodyDistance nearest = *truth.nearest(BodyKind::robot, {BodyKind::person, BodyKind::object});
    EXPECT_EQ(nearest.distance_m, all_m);
    EXPECT_EQ(truth.between(nearest.first, nearest.second)->distance_m, all_m);
    EXPECT_FALSE(truth.nearest(BodyKind::robot, {BodyKind::room}).has_value());
  }
}

TEST(CellTruth, WrongIndicesAreRefused) {
  Workcell cell;
  cell.bodies = {body("floor", BodyKind::room), body("wall", BodyKind::room)};
  cell.bodies[0].planes = cell.bodies[1].planes = {Plane{}};
  const CellTruth truth(cell);
  EXPECT_FALSE(truth.between(0, 1).has_value());
  EXPECT_THROW((void)truth.between(0, 2), Error);
  EXPECT_THROW((void)truth.between(1, 1), Error);
  EXPECT_THROW((void)truth.nearest(2, {BodyKind::room}), Error);
}

}  // namespace
}  // namespace depthgrid::workcell::testing
