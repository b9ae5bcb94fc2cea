#include "depthgrid/sensors/transform_history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace depthgrid::sensors {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kNow_ns = 10 * kSecond_ns;

/// A frame that is x metres to the right of its parent and turned about z.
messages::Transforms frame(const std::string& name, const std::string& parent, double x, double turn_rad = 0,
                           std::int64_t stamp_ns = 0) {
  messages::TransformStamped stamped;
  stamped.header = {.stamp = messages::time_of_nanoseconds(stamp_ns), .frame_id = parent};
  stamped.child_frame_id = name;
  stamped.transform.translation.x = x;
  stamped.transform.rotation = {.x = 0, .y = 0, .z = std::sin(turn_rad / 2), .w = std::cos(turn_rad / 2)};
  return {.transforms = {stamped}};
}

TEST(TransformHistory, GoesUpAndDown) {
  TransformHistory frames(0.1);
  frames.add(frame("base", "map", 1), true, kNow_ns);
  frames.add(frame("/camera", "base", 2, std::numbers::pi / 2), true, kNow_ns);
  frames.add(frame("world", "map", 10), true, kNow_ns);
  const PlaceAtTime place = frames.find("/world", "camera", 5 * kSecond_ns);
  ASSERT_TRUE(place.T_world_frame) << place.reason;
  EXPECT_TRUE(place.T_world_frame->translation().isApprox(Eigen::Vector3d(-7, 0, 0)));
  EXPECT_TRUE((*place.T_world_frame * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(-7, 1, 0)));
  EXPECT_TRUE(frames.find("camera", "camera", 0).T_world_frame->isApprox(Pose::Identity()));
  const PlaceAtTime none = frames.find("world", "other", 0);
  EXPECT_FALSE(none.T_world_frame);
  EXPECT_FALSE(none.may_come);
  EXPECT_THAT(none.reason, HasSubstr("no transforms on /tf_static and /tf lead from frame 'other' to 'world'"));
}

TEST(TransformHistory, WhatMovesIsInterpolatedAndNeverHeld) {
  TransformHistory frames(0.25);
  frames.add(frame("camera", "flange", 0.5), true, kNow_ns);
  for (const int tenth : {0, 1, 2, 3, 7}) {
    frames.add(frame("flange", "world", 0.1 * tenth, 0.1 * tenth, tenth * kSecond_ns / 10), false, kNow_ns);
  }
  frames.add(frame("flange", "world", 99, 0, 7 * kSecond_ns / 10), false, kNow_ns);  // of the same time: passed over
  const PlaceAtTime between = frames.find("world", "camera", kSecond_ns / 4);
  ASSERT_TRUE(between.T_world_frame) << between.reason;
  EXPECT_NEAR(between.T_world_frame->translation().x(), 0.25 + 0.5 * std::cos(0.25), 1e-9);
  EXPECT_NEAR(between.T_world_frame->translation().y(), 0.5 * std::sin(0.25), 1e-9);
  EXPECT_TRUE(frames.find("world", "camera", kSecond_ns / 10).T_world_frame) << "one of that very time";
  const PlaceAtTime after = frames.find("world", "camera", kSecond_ns * 8 / 10);
  EXPECT_FALSE(after.T_world_frame);
  EXPECT_TRUE(after.may_come);
  EXPECT_THAT(after.reason, HasSubstr("the newest transform of frame 'flange' on /tf is 0.1"));
  const PlaceAtTime gap = frames.find("world", "camera", kSecond_ns / 2);
  EXPECT_FALSE(gap.T_world_frame);
  EXPECT_FALSE(gap.may_come);
  EXPECT_THAT(gap.reason, HasSubstr("has no transform on /tf for 0.4"));
  EXPECT_THAT(frames.find("world", "camera", -1).reason, HasSubstr("is as old as the image"));
}

TEST(TransformHistory, WhatLiesInTheFutureIsRefusedAndHidesNothing) {
  TransformHistory frames(0.25);
  frames.add(frame("camera", "world", 1, 0, kNow_ns), false, kNow_ns);
  frames.add(frame("camera", "world", 99, 0, kNow_ns + 3600 * kSecond_ns), false, kNow_ns);
  const PlaceAtTime between = frames.find("world", "camera", kNow_ns + kSecond_ns / 20);
  EXPECT_FALSE(between.T_world_frame);
  EXPECT_TRUE(between.may_come);
  EXPECT_THAT(between.reason, HasSubstr("frame 'camera' that lies 3600.0"));
  frames.add(frame("camera", "world", 2, 0, kNow_ns + kSecond_ns / 10), false, kNow_ns + kSecond_ns / 10);
  const PlaceAtTime place = frames.find("world", "camera", kNow_ns + kSecond_ns / 20);
  ASSERT_TRUE(place.T_world_frame) << place.reason;
  EXPECT_NEAR(place.T_world_frame->translation().x(), 1.5, 1e-12);
  TransformHistory only(0.25);
  only.add(frame("camera", "world", 99, 0, kNow_ns + kSecond_ns), false, kNow_ns);
  EXPECT_THAT(only.find("world", "camera", kNow_ns).reason, HasSubstr("1.000000 s in the future was refused"));
}

TEST(TransformHistory, AClockThatIsSetBackForgetsWhereTheFrameWas) {
  TransformHistory frames(0.25);
  for (const int tenth : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    frames.add(frame("camera", "world", 0.1 * tenth, 0, tenth * kSecond_ns / 10), false, kNow_ns);
  }
  ASSERT_TRUE(frames.find("world", "camera", kSecond_ns / 2).T_world_frame);
  frames.add(frame("camera", "world", 5, 0, 4 * kSecond_ns / 10), false, kNow_ns);  // 0.7 s back
  const PlaceAtTime after = frames.find("world", "camera", kSecond_ns / 2);
  EXPECT_FALSE(after.T_world_frame) << "it stood elsewhere when it was this time before";
  EXPECT_TRUE(after.may_come);
  EXPECT_FALSE(frames.find("world", "camera", kSecond_ns / 4).T_world_frame);
  frames.add(frame("camera", "world", 6, 0, 6 * kSecond_ns / 10), false, kNow_ns);
  EXPECT_NEAR(frames.find("world", "camera", kSecond_ns / 2).T_world_frame->translation().x(), 5.5, 1e-9);
  frames.add(frame("world", "map", 1), true, kNow_ns);
  frames.forget_moving();
  EXPECT_FALSE(frames.find("world", "camera", kSecond_ns / 2).T_world_frame);
  EXPECT_TRUE(frames.find("map", "world", kSecond_ns / 2).T_world_frame) << "what stands is of no time";
}

TEST(TransformHistory, NonsenseIsPassedOverAndRingsEnd) {
  TransformHistory frames(0.1);
  messages::Transforms broken = frame("camera", "world", 1);
  broken.transforms[0].transform.rotation.w = 3;
  frames.add(broken, true, kNow_ns);
  EXPECT_FALSE(frames.find("world", "camera", 0).T_world_frame);
  broken = frame("camera", "world", std::nan(""));
  frames.add(broken, true, kNow_ns);
  EXPECT_FALSE(frames.find("world", "camera", 0).T_world_frame);
  frames.add(frame("a", "b", 1), true, kNow_ns);
  frames.add(frame("b", "a", 1), true, kNow_ns);
  EXPECT_THAT(frames.find("world", "a", 0).reason, HasSubstr("go around in a ring"));
}

TEST(TransformHistory, AFrameThatIsPutElsewhereForgetsWhereItWas) {
  TransformHistory frames(0.1);
  frames.add(frame("camera", "left", 1), true, kNow_ns);
  frames.add(frame("left", "world", 1), true, kNow_ns);
  frames.add(frame("camera", "world", 5), true, kNow_ns);
  EXPECT_NEAR(frames.find("world", "camera", 0).T_world_frame->translation().x(), 5, 1e-12);
}

}  // namespace
}  // namespace depthgrid::sensors
