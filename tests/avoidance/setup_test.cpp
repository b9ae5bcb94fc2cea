// What every user of the loop needs before it: limits from the model, a history that is fed, a radius that suffices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "avoidance/flat_wall.hpp"
#include "depthgrid/avoidance/history_port.hpp"
#include "depthgrid/avoidance/model_limits.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/views/surveillance_radius.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::avoidance {
namespace {

using depthgrid::test::thrown_message;
using ::testing::HasSubstr;

/// A chain of `joints` joints of this type with this <limit>.
robot::RobotModel chain(int joints, const std::string& type, const std::string& limit) {
  std::string text = "<robot name='chain'><link name='l0'/>";
  for (int i = 1; i <= joints; ++i) {
    const std::string n = std::to_string(i);
    text += "<link name='l" + n + "'/><joint name='j" + n + "' type='" + type + "'><parent link='l" +
            std::to_string(i - 1) + "'/><child link='l" + n + "'/><axis xyz='0 0 1'/>" + limit + "</joint>";
  }
  return robot::RobotModel(robot::parse_urdf(text + "</robot>", "chain.urdf"));
}

TEST(JointLimitsOfAModel, AreItsRangesAndSpeeds) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const control::JointLimits limits = joint_limits(model, 5);
  ASSERT_EQ(limits.joints(), 7);
  for (Eigen::Index i = 0; i < 7; ++i) {
    const robot::Joint& joint = model.joints()[static_cast<std::size_t>(i)];
    EXPECT_EQ(limits.lowest_rad[i], joint.lower);
    EXPECT_EQ(limits.highest_rad[i], joint.upper);
    EXPECT_EQ(limits.velocity_rad_s[i], joint.max_speed);
    EXPECT_EQ(limits.acceleration_rad_s2[i], 5);
  }
  const control::JointLimits endless = joint_limits(chain(2, "continuous", "<limit velocity='1' effort='1'/>"), 5);
  EXPECT_EQ(endless.lowest_rad[0], -1000);
  EXPECT_EQ(endless.highest_rad[1], 1000);
}

TEST(JointLimitsOfAModel, RefuseWhatTheControllerCannotKeep) {
  const auto refused = [](const robot::RobotModel& model, double acceleration_rad_s2 = 5) {
    return thrown_message([&] { (void)joint_limits(model, acceleration_rad_s2); });
  };
  const std::string good = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";
  EXPECT_EQ(refused(chain(16, "revolute", good)), "");
  EXPECT_THAT(refused(chain(17, "revolute", good)), HasSubstr("chain.urdf: 17 joints, the controller takes 1 to 16"));
  EXPECT_THAT(refused(chain(200, "revolute", good)), HasSubstr("200 joints"));
  EXPECT_THAT(refused(chain(2, "fixed", "")), HasSubstr("0 joints"));
  EXPECT_THAT(refused(chain(2, "revolute", "<limit lower='0' upper='0' velocity='1' effort='1'/>")),
              HasSubstr("joint 'j1' reaches from 0 to 0"));
  EXPECT_THAT(refused(chain(2, "continuous", "")), HasSubstr("joint 'j1' has no speed limit"));
  EXPECT_THAT(refused(chain(2, "revolute", good), 0), HasSubstr("acceleration"));
  EXPECT_THAT(refused(chain(2, "revolute", good), std::nan("")), HasSubstr("acceleration"));
}

/// States as they are told.
class ToldArm final : public control::RobotPort {
 public:
  bool read(control::JointState& state) noexcept override {
    if (there) {
      state = told;
    }
    return there;
  }
  bool write(const control::JointCommand& /*command*/) noexcept override { return ++written > 0; }
  control::JointState told{test::bent(), control::JointVector::Zero(7), 0};
  bool there = true;
  int written = 0;
};

TEST(HistoryPort, RemembersEveryNewState) {
  ToldArm arm;
  robot::JointHistory history(7, 16, 0.1, 0);
  HistoryPort port(arm, history);
  control::JointState state;
  std::vector<double> q(7);
  arm.told.time_s = 1;
  EXPECT_TRUE(port.read(state));
  arm.told.position_rad[0] += 0.2;
  EXPECT_TRUE(port.read(state)) << "the same time again: passed on, not remembered";
  EXPECT_EQ(state.position_rad, arm.told.position_rad);
  EXPECT_EQ(port.refused(), 1);
  ASSERT_TRUE(history.at(1, q).known());
  EXPECT_EQ(q[0], test::bent()[0]);
  arm.there = false;
  arm.told.time_s = 1.05;
  EXPECT_FALSE(port.read(state));
  EXPECT_FALSE(history.at(1.05, q).known());
  arm.there = true;
  EXPECT_TRUE(port.read(state));
  ASSERT_TRUE(history.at(1.05, q).known());
  EXPECT_EQ(q[0], arm.told.position_rad[0]);
  EXPECT_TRUE(port.write({}));
  EXPECT_EQ(arm.written, 1);
}

TEST(SurveillanceRadius, LeavesRhoUntilTheImageIsAsOldAsItMayBe) {
  constexpr double kRho_m = 0.3;
  constexpr double kGreatestAge_s = 0.06;
  const Rig rig = test::one_camera();
  views::Settings settings = test::search_settings(rig);
  settings.rho_m = views::surveillance_radius_m(kRho_m, settings.v_max_m_s, kGreatestAge_s, 0);
  EXPECT_EQ(settings.rho_m, kRho_m + 2 * kGreatestAge_s);
  search::SearchEvaluator evaluator(rig, settings);
  const std::vector<float> wall(64 * 48, 3.2F);
  const Frame frame{depth_view(wall, 64, 48), {}, 5.0};
  ASSERT_TRUE(evaluator.update(0, frame).taken());
  const Capsule part = Capsule::point({0, 0, 0.6});  // 1.2 m before the wall
  const auto told_m = [&](double age_s) {
    const Answer answer = evaluator.distance(part, 5.0 + age_s);
    EXPECT_EQ(answer.nearest.state, ProximityState::beyond_rho);
    return answer.distance_now_m;
  };
  EXPECT_GE(told_m(0), kRho_m);
  EXPECT_NEAR(told_m(kGreatestAge_s), kRho_m, 1e-9);
  EXPECT_LT(told_m(kGreatestAge_s + 0.01), kRho_m);
}

TEST(SurveillanceRadius, RefusesWhatIsNoRadius) {
  const auto refused = [](double rho_m, double v_max_m_s, double age_s, double blind_m = 0) {
    return thrown_message([&] { (void)views::surveillance_radius_m(rho_m, v_max_m_s, age_s, blind_m); }) != "";
  };
  EXPECT_FALSE(refused(0.4, 1, 0.1, 0.2));
  EXPECT_TRUE(refused(0.4, 1, 0.1, -0.2));
  EXPECT_TRUE(refused(0.4, 1, 0.1, std::nan("")));
  EXPECT_FALSE(refused(0.4, 0, 0));
  EXPECT_TRUE(refused(0, 1, 1));
  EXPECT_TRUE(refused(0.4, -1, 0));
  EXPECT_TRUE(refused(0.4, 1, -0.1));
  EXPECT_TRUE(refused(0.4, std::nan(""), 0));
  EXPECT_TRUE(refused(0.4, 1, std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace depthgrid::avoidance
