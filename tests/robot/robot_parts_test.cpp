// What is asked for its distance: which links, which first, and how thick.
#include "depthgrid/robot/robot_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::robot {
namespace {

using depthgrid::test::thrown_message;
using ::testing::HasSubstr;

TEST(RobotParts, BeginWithTheFlangeAndLeaveTheBaseOut) {
  const RobotModel model = kuka_lwr4();
  const auto points = nine_control_points(model);
  ASSERT_EQ(points.size(), 9U);
  EXPECT_EQ(points.front().link, model.link_index("lwr_7_link"));
  for (const LinkCapsule& point : points) {
    EXPECT_EQ(point.capsule.radius_m, 0);
    EXPECT_EQ(point.capsule.a, point.capsule.b);
  }
  constexpr std::array<double, 9> kAlongLink_m{0, 0, 0.1, 0, 0.1, 0, 0.1, 0, 0.1};
  constexpr std::array<const char*, 9> kLinks{"lwr_7_link", "lwr_6_link", "lwr_5_link", "lwr_5_link", "lwr_4_link",
                                              "lwr_4_link", "lwr_3_link", "lwr_3_link", "lwr_2_link"};
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].link, model.link_index(kLinks[i])) << i;
    EXPECT_EQ(points[i].capsule.a, Eigen::Vector3d(0, 0, kAlongLink_m[i])) << i;
  }
  const auto capsules = moving_capsules(model);
  ASSERT_EQ(capsules.size(), 6U);
  EXPECT_EQ(capsules.front().link, model.link_index("lwr_7_link"));
  EXPECT_EQ(capsules.back().link, model.link_index("lwr_2_link"));
  EXPECT_EQ(moving_capsules(model, 1).size(), 7U);
  EXPECT_THAT(thrown_message([&] { (void)moving_capsules(model, 9); }), HasSubstr("moved by 9 joints"));
}

TEST(RobotParts, TakeTheOptionsOfTheCapsules) {
  const RobotModel model = kuka_lwr4();
  const auto plain = moving_capsules(model);
  const auto fewer = moving_capsules(model, 2, {.left_out = {"lwr_4_link"}, .margin_m = 0.03});
  ASSERT_EQ(fewer.size(), plain.size() - 1);
  EXPECT_EQ(fewer.front().capsule.radius_m, plain.front().capsule.radius_m + 0.03);
  for (const LinkCapsule& part : fewer) {
    EXPECT_NE(part.link, model.link_index("lwr_4_link"));
  }
  EXPECT_THAT(thrown_message([&] { (void)moving_capsules(model, 2, {.left_out = {"tool"}, .margin_m = 0}); }),
              HasSubstr("'tool'"));
}

TEST(RobotParts, PutTheTipFirstAndKeepTheOrderOfTheOthers) {
  const RobotModel model = kuka_lwr4();
  const auto links = [](const std::vector<LinkCapsule>& parts) {
    std::vector<std::size_t> result;
    for (const LinkCapsule& part : parts) {
      result.push_back(part.link);
    }
    return result;
  };
  const auto plain = moving_capsules(model);
  const std::vector<std::size_t> was = links(plain);
  EXPECT_EQ(links(tip_first(plain, was[0])), was);
  EXPECT_EQ(links(tip_first(plain, was[2])), (std::vector{was[2], was[0], was[1], was[3], was[4], was[5]}));
  // A link without a part: its origin.
  const std::size_t base = model.link_index("lwr_0_link");
  const auto with_point = tip_first(plain, base);
  ASSERT_EQ(with_point.size(), plain.size() + 1);
  EXPECT_EQ(with_point[0].link, base);
  EXPECT_EQ(with_point[0].capsule.radius_m, 0);
  EXPECT_EQ(with_point[0].capsule.a, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(with_point[1].link, was[0]);
}

}  // namespace
}  // namespace depthgrid::robot
