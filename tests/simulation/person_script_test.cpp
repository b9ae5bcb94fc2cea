// The scripted person: never faster than stated, never torn apart, and where each motion says.
#include "depthgrid/simulation/person_script.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "depthgrid/core/error.hpp"
#include "simulation/random_scenes.hpp"

namespace depthgrid::simulation::testing {
namespace {

constexpr std::size_t kFirstArm = 5;
constexpr std::size_t kFirstLeg = 11;

std::string where(Motion motion, std::uint64_t seed_of_script, double time_s) {
  return std::string(to_string(motion)) + ", seed " + std::to_string(seed_of_script) + ", at " +
         std::to_string(time_s) + " s";
}

/// Calls visit(script, seed) for some scripts of every motion.
template <class Visit>
void for_each_script(int of_each, const PersonStage& stage, Visit&& visit) {
  for (const Motion motion : motions()) {
    for (int n = 0; n < of_each; ++n) {
      const std::uint64_t script_seed = seed() + static_cast<unsigned long>(n);
      visit(PersonScript(motion, stage, script_seed), script_seed);
    }
  }
}

double point_to_line_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (b - a).cross(p - a).norm() / (b - a).norm();
}

TEST(PersonScript, NothingMovesFasterThanStated) {
  double fastest_m_s = 0;
  PersonStage stage;
  stage.v_max_m_s = 1.7;
  for_each_script(count(12), stage, [&](const PersonScript& script, std::uint64_t n) {
    constexpr double kStep = 2e-3;
    double of_script_m_s = 0;
    PersonState before = script.at(-kStep);
    for (double t = 0; t <= script.duration_s() + kStep; t += kStep) {
      const PersonState now = script.at(t);
      for (std::size_t i = 0; i < now.parts_world.size(); ++i) {
        for (const double move_m : {(now.parts_world[i].a - before.parts_world[i].a).norm(),
                                    (now.parts_world[i].b - before.parts_world[i].b).norm()}) {
          of_script_m_s = std::max(of_script_m_s, move_m / kStep);
        }
      }
      if (now.carried_world) {
        const Pose moved = now.carried_world->T_world_box;
        for (const double x : {-1.0, 1.0}) {
          const Eigen::Vector3d corner = Eigen::Vector3d(x, 1, 1).cwiseProduct(now.carried_world->half_size_m);
          of_script_m_s =
              std::max(of_script_m_s, (moved * corner - before.carried_world->T_world_box * corner).norm() / kStep);
        }
      }
      ASSERT_LE(of_script_m_s, script.v_max_m_s()) << where(script.motion(), n, t);
      before = now;
    }
    EXPECT_GT(of_script_m_s, 0.55 * script.v_max_m_s()) << where(script.motion(), n, 0) << ": needlessly slow";
    fastest_m_s = std::max(fastest_m_s, of_script_m_s);
  });
  EXPECT_GT(fastest_m_s, 0.85 * stage.v_max_m_s);
}

TEST(PersonScript, BonesKeepTheirLengthAndOneFootIsOnTheFloor) {
  const PersonStage stage;
  for_each_script(count(4), stage, [&](const PersonScript& script, std::uint64_t n) {
    const PersonState first = script.at(0);
    const auto length_m = [](const Capsule& part) { return (part.b - part.a).norm(); };
    for (double t = 0; t < script.duration_s(); t += 0.03) {
      const PersonState now = script.at(t);
      for (std::size_t i = 0; i < now.parts_world.size(); ++i) {
        ASSERT_NEAR(length_m(now.parts_world[i]), length_m(first.parts_world[i]), 1e-9) << where(script.motion(), n, t);
        ASSERT_EQ(now.parts_world[i].radius_m, first.parts_world[i].radius_m);
        validate(now.parts_world[i]);
      }
      for (const std::size_t limb : {kFirstArm, kFirstArm + 3, kFirstLeg, kFirstLeg + 3}) {
        ASSERT_LT((now.parts_world[limb].b - now.parts_world[limb + 1].a).norm(), 1e-9);
      }
      double lowest_m = 10;
      for (const Capsule& part : now.parts_world) {
        lowest_m = std::min({lowest_m, part.a.z() - part.radius_m, part.b.z() - part.radius_m});
      }
      ASSERT_NEAR(lowest_m, stage.floor_m, 1e-9) << where(script.motion(), n, t);
      ASSERT_EQ(now.carried_world.has_value(), script.motion() == Motion::carry_box);
      if (now.carried_world) {
        ASSERT_LT((now.carried_world->T_world_box.translation() - between_hands(now.parts_world)).norm(), 1e-12);
      }
    }
  });
}

TEST(PersonScript, EveryMotionDoesWhatItIsNamedFor) {
  PersonStage stage;
  stage.robot_world = {0.1, 0.05, 0.6};
  for_each_script(count(30), stage, [&](const PersonScript& script, std::uint64_t n) {
    const Eigen::Vector3d& robot = stage.robot_world;
    double nearest_tip_m = 10;
    double nearest_body_m = 10;
    double nearest_box_m = 10;
    double hidden_tip_m = 10;  // beside the line of sight, beyond the robot
    double crossing_m = 10;    // an arm's axis beside the line of sight, before the robot
    for (double t = 0; t < script.duration_s(); t += 0.02) {
      const PersonState now = script.at(t);
      for (const std::size_t arm : {kFirstArm, kFirstArm + 3}) {
        const Eigen::Vector3d tip = now.parts_world[arm + 2].b;
        nearest_tip_m = std::min(nearest_tip_m, (tip - robot).norm());
        if ((tip - robot).dot(robot - stage.camera_world) > 0) {
          hidden_tip_m = std::min(hidden_tip_m, point_to_line_m(tip, stage.camera_world, robot));
        } else if ((robot - tip).norm() > 0.5) {
          crossing_m = std::min(crossing_m, point_to_line_m(tip, stage.camera_world, robot));
        }
      }
      for (const Capsule& part : now.parts_world) {
        nearest_body_m = std::min(nearest_body_m, (nearest_point(part, robot) - robot).norm());
      }
      if (now.carried_world) {
        nearest_box_m = std::min(nearest_box_m, (nearest_point(*now.carried_world, robot) - robot).norm());
      }
    }
    const std::string which = where(script.motion(), n, script.duration_s());
    EXPECT_GT(script.duration_s(), 2.0) << which;
    EXPECT_LT(script.duration_s(), 40.0) << which;
    switch (script.motion()) {
      case Motion::walk_in:
        EXPECT_LT(nearest_body_m, 1.2) << which;
        EXPECT_GT(nearest_body_m, 0.3) << which;
        break;
      case Motion::reach:
        EXPECT_LT(nearest_tip_m, 0.45) << which;
        break;
      case Motion::carry_box:
        EXPECT_LT(nearest_box_m, 0.5) << which;
        break;
      case Motion::hand_behind_robot:
        EXPECT_LT(hidden_tip_m, 0.1) << which;
        EXPECT_LT(nearest_tip_m, 0.4) << which;
        break;
      case Motion::arm_between:
        EXPECT_LT(crossing_m, 0.05) << which;
        EXPECT_GT(nearest_body_m, 0.5) << which;
        break;
    }
    // Comes from outside and leaves.
    for (const double t : {0.0, script.duration_s()}) {
      for (const Capsule& part : script.at(t).parts_world) {
        EXPECT_GT((part.a - robot).head<2>().norm(), 1.4) << which;
      }
    }
  });
}

TEST(PersonScript, SeedMotionAndTimeDecideAlone) {
  const auto tip = [](Motion motion, std::uint64_t n, double t) {
    return PersonScript(motion, {}, n).at(t).parts_world[7].b;
  };
  for (const Motion motion : motions()) {
    EXPECT_EQ(tip(motion, 3, 2.5), tip(motion, 3, 2.5));
    EXPECT_NE(tip(motion, 3, 2.5), tip(motion, 4, 2.5));
    const PersonScript script(motion, {}, 1);
    EXPECT_EQ(script.at(-5).parts_world[0].a, script.at(0).parts_world[0].a);
    EXPECT_EQ(script.at(script.duration_s() + 5).parts_world[0].a, script.at(script.duration_s()).parts_world[0].a);
  }
}

TEST(PersonScript, BrokenStagesAreRefused) {
  PersonStage stage;
  stage.v_max_m_s = 0;
  EXPECT_THROW(PersonScript(Motion::reach, stage, 1), Error);
  stage = {};
  stage.entrance_m = 1;
  EXPECT_THROW(PersonScript(Motion::reach, stage, 1), Error);
  stage = {};
  stage.robot_world.x() = std::nan("");
  EXPECT_THROW(PersonScript(Motion::reach, stage, 1), Error);
}

}  // namespace
}  // namespace depthgrid::simulation::testing
