// Each counter of the avoidance experiments is shown one thing to count.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "avoidance/flat_wall.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/campaign/campaign_totals.hpp"
#include "lab/experiments/loop/contact_watch.hpp"
#include "lab/experiments/loop/motion_count.hpp"

namespace depthgrid::experiments {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 0.002;
constexpr double kFar = std::numeric_limits<double>::infinity();

TEST(MotionCount, CountsTouchesStopsAndFalseStops) {
  MotionCount count(kPeriod, 0.4, 0.3);
  RunSummary summary;
  count.take(0.4, kFar, kFar, summary);
  count.take(0.041, 0.5, 0.5, summary);
  EXPECT_EQ(summary.stopped_s, 0);
  EXPECT_EQ(summary.smallest_person_m, 0.5);
  count.take(0.039, 0.5, 0.31, summary);  // nothing within 0.3 m
  EXPECT_DOUBLE_EQ(summary.stopped_s, kPeriod);
  EXPECT_DOUBLE_EQ(summary.false_stop_s, kPeriod);
  count.take(0, 0.29, kFar, summary);
  count.take(0, kFar, 0.1, summary);
  EXPECT_DOUBLE_EQ(summary.stopped_s, 3 * kPeriod);
  EXPECT_DOUBLE_EQ(summary.false_stop_s, kPeriod);
  EXPECT_EQ(summary.smallest_person_m, 0.29);
  EXPECT_EQ(summary.object_contacts, 0);
  for (const double object_m : {0.0, 0.0, 0.01, 0.0}) {
    count.take(0.4, kFar, object_m, summary);
  }
  EXPECT_EQ(summary.object_contacts, 2) << "once for each time that it begins";
}

/// Says of every part that something is so far away.
class SaysFar final : public DistanceEvaluator {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "says far"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return 0; }
  [[nodiscard]] double image_time_s(std::size_t) const noexcept override { return Proximity::kNaN; }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&) noexcept override { return {}; }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&, const Pose&) noexcept override { return {}; }
  void evaluate(std::span<const Capsule>, double, std::span<Answer> answers) noexcept override {
    for (Answer& answer : answers) {
      answer = Answer{};
      answer.nearest.state = ProximityState::measured;
      answer.nearest.distance_m = answer.distance_now_m = 0.3;
      answer.blind_m = 0;
    }
  }
};

/// The end effector goes along x.
class AlongX final : public control::MotionTask {
 public:
  control::Task rows(const control::EndEffector& tip) noexcept override {
    return {tip.jacobian.topRows<3>(), Vector3d(0.3, 0, 0)};
  }
};

/// A loop in motion that holds everything for 0.3 m away, and its watch.
class Watched {
 public:
  explicit Watched(Method method)
      : watch_(method, model_, loop_, loop_settings_.parts, settings_),
        arm_(loop_settings_.controller.limits, kPeriod, avoidance::test::bent()) {
    EXPECT_TRUE(loop_.start(arm_));
    cycles(100);
    const Vector3d before = tip();
    cycles(1);
    speed_m_s = (tip() - before).x() / kPeriod;
  }
  /// A period later something is truly so far from the end effector, in this direction.
  void take(double distance_m, const Vector3d& towards = Vector3d::UnitX()) {
    cycles(1);
    const Vector3d none = Vector3d::Constant(Proximity::kNaN);
    const bool touches = distance_m <= 0;
    watch_.take(time_s_,
                {distance_m, loop_settings_.parts[0].link, touches ? none : tip(),
                 touches ? none : Vector3d(tip() + distance_m * towards)},
                summary);
  }
  /// The cause of a contact that someone runs into who comes so fast and begins 1 cm away.
  ContactCause cause(double person_m_s, const Vector3d& towards = Vector3d::UnitX()) {
    const double closing_m_s = person_m_s + towards.x() * speed_m_s;
    take(0.0101, towards);
    take(0.0101 - closing_m_s * kPeriod, towards);
    take(0);
    return summary.contacts.back().cause;
  }
  RunSummary summary;
  double speed_m_s = 0;

 private:
  [[nodiscard]] Vector3d tip() const { return loop_.report().end_effector_world; }
  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      EXPECT_TRUE(loop_.cycle(arm_, time_s_));
      arm_.advance();
      time_s_ += kPeriod;
    }
  }
  robot::RobotModel model_ = robot::kuka_lwr4();
  AvoidanceSettings settings_;
  avoidance::LoopSettings loop_settings_ = avoidance::test::loop_settings(robot::moving_capsules(model_));
  AlongX task_;
  SaysFar evaluator_;
  avoidance::AvoidanceLoop loop_{{model_}, task_, evaluator_, loop_settings_};
  ContactWatch watch_;
  control::SimulatedArm arm_;
  double time_s_ = 0;
};

TEST(ContactWatch, CountsAnswersThatAreTooFar) {
  Watched search(Method::search);
  search.take(0.295);  // 5 mm are not counted
  EXPECT_EQ(search.summary.compared, 1);
  EXPECT_EQ(search.summary.over_estimates, 0);
  search.take(0.25);
  EXPECT_EQ(search.summary.compared, 2);
  EXPECT_EQ(search.summary.over_estimates, 1);
  EXPECT_NEAR(search.summary.largest_over_estimate_m, 0.05, 1e-12);
  search.take(0.45);  // beyond rho
  search.take(0);
  EXPECT_EQ(search.summary.compared, 3);
  EXPECT_EQ(search.summary.over_estimates, 2);
  EXPECT_NEAR(search.summary.largest_over_estimate_m, 0.3, 1e-12);
  Watched letter(Method::letter_two);
  letter.take(0.1);
  EXPECT_EQ(letter.summary.compared, 0) << "asks about points";
}

TEST(ContactWatch, CountsContactsAndTheirTime) {
  Watched watched(Method::none);
  for (const double distance_m : {0.1, 0.0, 0.0, 0.01, 0.0, 0.03, 0.0}) {
    watched.take(distance_m);
  }
  EXPECT_EQ(watched.summary.contacts.size(), 2U) << "one until they are 2 cm apart";
  EXPECT_NEAR(watched.summary.in_contact_s, 4 * kPeriod, 1e-12);
  ASSERT_TRUE(watched.summary.contacts[0].fastest_during_m_s);
  EXPECT_NEAR(*watched.summary.contacts[0].fastest_during_m_s, watched.speed_m_s, 0.01);
}

TEST(ContactWatch, TellsEveryCause) {
  const AvoidanceSettings settings;
  Watched none(Method::none);
  EXPECT_GT(none.speed_m_s, 0.2);
  none.take(0);
  EXPECT_EQ(none.summary.contacts.back().cause, ContactCause::touched_from_the_start);
  EXPECT_EQ(Watched(Method::none).cause(0.5), ContactCause::robot_came);
  EXPECT_EQ(Watched(Method::none).cause(settings.v_max_m_s + 0.1), ContactCause::faster_than_v_max);
  EXPECT_EQ(Watched(Method::none).cause(0.5, -Vector3d::UnitX()), ContactCause::robot_stood) << "it went away";
  EXPECT_EQ(Watched(Method::none).cause(0.5, Vector3d::UnitY()), ContactCause::robot_stood);
  EXPECT_EQ(Watched(Method::search).cause(0.5), ContactCause::hidden);
}

// Two motions with one of everything that is counted.
TEST(CampaignTotals, ContainEveryCounterOfEveryMotion) {
  RunSummary run;
  run.task_share = 2;
  run.smallest_person_m = 0.1;
  run.in_contact_s = 0.25;
  run.stopped_s = 1;
  run.false_stop_s = 0.5;
  run.compared = 7;
  run.over_estimates = 3;
  run.largest_over_estimate_m = 0.02;
  run.object_contacts = 4;
  for (const ContactCause cause : kContactCauses) {
    Contact contact;
    contact.cause = cause;
    contact.robot_m_s = 0.1;
    contact.fastest_during_m_s = 0.3;
    run.contacts.push_back(contact);
  }
  run.contacts[2].robot_m_s = 0.2;
  run.contacts[3].fastest_during_m_s = 0.4;
  RunSummary other;
  other.task_share = 1;
  other.smallest_person_m = 0.05;
  CampaignState state;
  state.motions[0].runs[Method::search] = run;
  state.motions[1].runs[Method::search] = other;
  state.motions[1].runs[Method::search].over_estimates = 1;
  state.motions[1].runs[Method::search].object_contacts = 1;
  const MethodTotals sum = totals(state, Method::search, 5);
  EXPECT_EQ(sum.motions, 2);
  EXPECT_EQ(sum.with_contact, 1);
  EXPECT_EQ(sum.contacts, 5);
  for (const ContactCause cause : kContactCauses) {
    EXPECT_EQ(sum.causes.at(cause), 1) << to_string(cause);
  }
  EXPECT_EQ(sum.worst_robot_m_s, 0.2);
  EXPECT_EQ(sum.worst_during_m_s, 0.4);
  EXPECT_EQ(sum.object_contacts, 5);
  EXPECT_EQ(sum.in_contact_s, 0.25);
  EXPECT_DOUBLE_EQ(sum.stopped_share, 0.1);
  EXPECT_DOUBLE_EQ(sum.false_stop_share, 0.05);
  EXPECT_EQ(sum.over_estimates, 4);
  EXPECT_EQ(sum.largest_over_estimate_m, 0.02);
  EXPECT_EQ(sum.compared, 7);
  EXPECT_EQ(sum.smallest_m, 0.05);
  EXPECT_EQ(sum.median_smallest_m, 0.1);
  EXPECT_NEAR(sum.s_per_vertex, 10.0 / 3, 1e-12);
  EXPECT_EQ(contacts_caused(state, Method::search).size(), 2U);
}

}  // namespace
}  // namespace depthgrid::experiments
