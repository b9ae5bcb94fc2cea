// The numbers that the loop hands from one room to the next, on random arms: where the parts are, where an answer acts,
// how fast that place moves, and what the joints may do then. All of it worked out here again, by differences.
#include "robot/random_arm.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "support/random_run.hpp"

namespace depthgrid::avoidance {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using robot::Random;

/// Answers that the test chose, and what was asked.
class Chosen final : public DistanceEvaluator {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "chosen"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return 0; }
  [[nodiscard]] double image_time_s(std::size_t) const noexcept override { return Proximity::kNaN; }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&) noexcept override { return {}; }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&, const Pose&) noexcept override { return {}; }
  void evaluate(std::span<const Capsule> capsules, double, std::span<Answer> out) noexcept override {
    asked.assign(capsules.begin(), capsules.end());
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Capsule& c = capsules[i];
      const Vector3d on_axis = c.a + along[i] * (c.b - c.a);
      out[i] = Answer{};
      out[i].nearest.distance_m = out[i].distance_now_m = distance_m[i];
      out[i].nearest.direction_world = towards[i];
      out[i].nearest.nearest_world = on_axis + distance_m[i] * towards[i];
      out[i].nearest.state = ProximityState::measured;
      if (along[i] >= 0) {
        out[i].on_axis_world = on_axis;
      }
      out[i].hybrid_direction_world = towards[i];
      out[i].blind_m = 0;
    }
  }
  std::vector<double> distance_m, along;  ///< where on the axis it acts; below 0: the answer does not say
  std::vector<Vector3d> towards;
  std::vector<Capsule> asked;
};

/// A robot that stands where it is told.
class Told final : public control::RobotPort {
 public:
  bool read(control::JointState& state) noexcept override {
    state = {q, control::JointVector::Zero(q.size()), 0};
    return true;
  }
  bool write(const control::JointCommand& command) noexcept override {
    commanded = command;
    return true;
  }
  control::JointVector q;
  control::JointCommand commanded;
};

/// Somewhere fast.
class Rush final : public control::MotionTask {
 public:
  control::Task rows(const control::EndEffector& tip) noexcept override {
    seen = tip;
    return {tip.jacobian.topRows<3>(), velocity_m_s};
  }
  control::EndEffector seen;
  Vector3d velocity_m_s = Vector3d::Zero();
};

/// An arm, its parts, the answers about them and the loop around all.
struct Case {
  Random random;
  robot::RandomArm arm;
  control::ControllerSettings controller;
  std::vector<robot::LinkCapsule> parts;
  Chosen chosen;
  Told told;
  Rush rush;

  Case(std::uint64_t seed, control::BodyLaw law, int part_count) : random(seed), arm(random) {
    const int joints = arm.joints();
    controller.limits.highest_rad = control::JointVector::Constant(joints, 1e3);
    controller.limits.lowest_rad = -controller.limits.highest_rad;
    controller.limits.velocity_rad_s.resize(joints);
    // Any velocity within one period: the box is what the obstacles leave.
    controller.limits.acceleration_rad_s2 = control::JointVector::Constant(joints, 1e9);
    for (int j = 0; j < joints; ++j) {
      controller.limits.velocity_rad_s[j] = random.uniform(0.5, 3);
    }
    controller.body.law = law;
    controller.body.gain_per_s = random.uniform(0.5, 3);
    controller.body.stop_m = 0.01;
    // The last ones are often the nearest.
    const double last_m = random.uniform(0.05, 0.5);
    for (int i = 0; i < part_count; ++i) {
      const auto link = static_cast<std::size_t>(random.integer(i == 0 ? arm.links() - 1 : 1, arm.links() - 1));
      parts.push_back({link, {random.in_cube(0.3), random.in_cube(0.3), 0.05}});
      chosen.distance_m.push_back(i + 8 < part_count ? random.uniform(0.05, 0.5) : random.uniform(0.02, last_m));
      chosen.along.push_back(random.integer(0, 4) == 0 ? -1.0 : random.uniform(0, 1));
      chosen.towards.push_back(random.unit());
    }
    rush.velocity_m_s = 2 * random.unit();
    told.q = joint_positions();
  }
  VectorXd joint_positions() {
    VectorXd q(arm.joints());
    for (double& one : q) {
      one = random.uniform(-3, 3);
    }
    return q;
  }
  [[nodiscard]] int link(std::size_t part) const { return static_cast<int>(parts[part].link); }
  /// Where the answer acts, in the frame of the part's link, when it was asked at q: that place goes with the link.
  [[nodiscard]] Vector3d acts_at_link(const VectorXd& q, std::size_t part) const {
    const Vector3d a = arm.at(q, link(part), parts[part].capsule.a);
    const Vector3d b = arm.at(q, link(part), parts[part].capsule.b);
    return arm.in_link(q, link(part), a + std::max(0.0, chosen.along[part]) * (b - a));
  }
  /// By how much a law lets the part approach, m/s; nothing beyond rho.
  [[nodiscard]] std::optional<double> allowed_m_s(std::size_t part) const {
    const control::BodySettings& body = controller.body;
    return chosen.distance_m[part] < body.rho_m
               ? std::optional(body.gain_per_s * std::max(0.0, chosen.distance_m[part] - body.stop_m))
               : std::nullopt;
  }
};

constexpr double kArmPeriod = 0.002;

/// Three cycles at three places, of which the first alone is evaluated: check(case, loop, q at the first, q now).
template <class Check>
void for_random_arms(std::int64_t default_count, control::BodyLaw law, int parts, Check&& check) {
  const auto run = depthgrid::test::random_run(default_count);
  for (std::int64_t i = 0; i < run.count && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("arm " + std::to_string(i) + "; " + run.reproduce());
    Case c(run.seed + static_cast<std::uint64_t>(i), law, parts);
    LoopSettings settings;
    settings.controller = c.controller;
    settings.parts = c.parts;
    settings.end_effector_limits = true;
    settings.evaluate_every = 3;
    AvoidanceLoop loop(c.arm.placed(), c.rush, c.chosen, settings);
    ASSERT_TRUE(loop.start(c.told));
    const VectorXd q_asked = c.told.q;
    for (int cycle = 0; cycle < 3; ++cycle) {
      SCOPED_TRACE("cycle " + std::to_string(cycle));
      ASSERT_TRUE(loop.cycle(c.told, cycle * kArmPeriod));
      ASSERT_EQ(loop.report().evaluated, cycle == 0);
      check(c, loop, q_asked, VectorXd(c.told.q));
      c.told.q = c.joint_positions();
    }
  }
}

TEST(RandomArm, PartsAndTipAreWhereTheMatricesHaveThem) {
  for_random_arms(100, control::BodyLaw::risk, 6,
                  [](const Case& c, const AvoidanceLoop& loop, const VectorXd& q_asked, const VectorXd& q) {
                    for (std::size_t i = 0; i < c.parts.size(); ++i) {
                      const Capsule& part = c.parts[i].capsule;
                      EXPECT_LT((loop.parts_world()[i].a - c.arm.at(q, c.link(i), part.a)).norm(), 1e-9);
                      EXPECT_LT((loop.parts_world()[i].b - c.arm.at(q, c.link(i), part.b)).norm(), 1e-9);
                      EXPECT_LT((c.chosen.asked[i].a - c.arm.at(q_asked, c.link(i), part.a)).norm(), 1e-9);
                      EXPECT_LT((c.chosen.asked[i].b - c.arm.at(q_asked, c.link(i), part.b)).norm(), 1e-9);
                      EXPECT_EQ(c.chosen.asked[i].radius_m, part.radius_m);
                    }
                    const Vector3d tip = c.arm.at(q, c.link(0), Vector3d::Zero());
                    EXPECT_LT((loop.report().end_effector_world - tip).norm(), 1e-9);
                    EXPECT_LT((c.rush.seen.T_world_tip.translation() - tip).norm(), 1e-9);
                    const MatrixXd jacobian = c.arm.jacobian(q, c.link(0), Vector3d::Zero());
                    EXPECT_LT((c.rush.seen.jacobian.topRows<3>() - jacobian).cwiseAbs().maxCoeff(), 1e-6);
                    // Away from what the first part was told of.
                    const Vector3d away = -c.chosen.towards[0] * loop.report().output.repulsion_m_s.norm();
                    EXPECT_LT((loop.report().output.repulsion_m_s - away).norm(), 1e-9);
                  });
}

// The limits of all joints, from the Jacobian of the very place where each answer acts.
TEST(RandomArm, LimitsAreThoseOfThePlaceWhereAnAnswerActs) {
  int limited = 0;
  for_random_arms(200, control::BodyLaw::approach_speed, 6,
                  [&limited](const Case& c, const AvoidanceLoop& loop, const VectorXd& q_asked, const VectorXd& q) {
                    VectorXd upper = c.controller.limits.velocity_rad_s;
                    VectorXd lower = -upper;
                    for (std::size_t i = 0; i < c.parts.size(); ++i) {
                      const VectorXd lever =
                          c.arm.jacobian(q, c.link(i), c.acts_at_link(q_asked, i)).transpose() * c.chosen.towards[i];
                      const double full = lever.cwiseAbs().dot(c.controller.limits.velocity_rad_s);
                      const auto allowed = c.allowed_m_s(i);
                      const double share = allowed && full > *allowed ? *allowed / full : 1.0;
                      for (Eigen::Index j = 0; share < 1 && j < lever.size(); ++j) {
                        const double limit = share * c.controller.limits.velocity_rad_s[j];
                        // Where the sign is that of rounding, either is right.
                        const bool either = std::abs(lever[j]) < 1e-6;
                        upper[j] = lever[j] > 0 && !either ? std::min(upper[j], limit) : upper[j];
                        lower[j] = lever[j] < 0 && !either ? std::max(lower[j], -limit) : lower[j];
                        ++limited;
                      }
                    }
                    const control::JointBox& box = loop.report().output.box;
                    EXPECT_LT((box.upper_rad_s - upper).cwiseAbs().maxCoeff(), 1e-6);
                    EXPECT_LT((box.lower_rad_s - lower).cwiseAbs().maxCoeff(), 1e-6);
                  });
  EXPECT_GT(limited, 0);
}

// With more parts than there is room for rows, each law keeps what it promises for every one.
TEST(RandomArm, NoneOfFiftyPartsApproachesFasterThanItsLawAllows) {
  for (const control::BodyLaw law : {control::BodyLaw::approach_speed, control::BodyLaw::approach_row}) {
    int near = 0;
    for_random_arms(40, law, 50,
                    [&near](const Case& c, const AvoidanceLoop& loop, const VectorXd& q_asked, const VectorXd& q) {
                      const VectorXd qd = loop.report().output.command.velocity_rad_s;
                      for (std::size_t i = 0; i < c.parts.size(); ++i) {
                        const Vector3d v = c.arm.jacobian(q, c.link(i), c.acts_at_link(q_asked, i)) * qd;
                        const auto allowed = c.allowed_m_s(i);
                        EXPECT_LE(v.dot(c.chosen.towards[i]), allowed ? *allowed + 1e-6 : 1e9) << "part " << i;
                        near += i >= 32 && allowed ? 1 : 0;
                      }
                      EXPECT_EQ(c.told.commanded.velocity_rad_s, loop.report().output.command.velocity_rad_s);
                    });
    EXPECT_GT(near, 0);
  }
}

}  // namespace
}  // namespace depthgrid::avoidance
