// What a device says of itself against what the cell states.
#include "depthgrid/monitor/device_says.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/thrown_message.hpp"

namespace depthgrid::monitor {
namespace {

using ::testing::HasSubstr;

PinholeCamera camera(double focal_px, double centre_px = 320) { return {640, 480, focal_px, focal_px, centre_px, 240}; }

std::string refused(const sensors::SourceInfo& told, const PinholeCamera& wanted) {
  return test::thrown_message([&] { refuse_other_images(told, wanted); });
}

TEST(DeviceSays, ItsOwnIntrinsicsHoldToTheDecimals) {
  const sensors::SourceInfo told{.name = "a camera", .serial = {}, .clock = {}, .intrinsics = camera(385)};
  EXPECT_EQ(refused(told, camera(385.1)), "");
  EXPECT_THAT(refused(told, camera(387)), HasSubstr("says fx 385, fy 385, cx 320, cy 240 px, the cell says 387"));
  EXPECT_THAT(refused(told, camera(385, 322)), HasSubstr("the cell says 385, 385, 322, 240"));
  EXPECT_EQ(refused(told, {848, 480, 385, 385, 320, 240}), "gives images of 640 x 480 pixels, the cell says 848 x 480");
}

TEST(DeviceSays, UsualOnesHoldToAFewPercent) {
  const sensors::SourceInfo told{.name = "a Kinect", .serial = {}, .clock = {}, .nominal = camera(575.8)};
  EXPECT_EQ(refused(told, camera(594)), "") << "a calibration";
  EXPECT_EQ(refused(told, camera(560, 350)), "");
  EXPECT_THAT(refused(told, camera(525)), HasSubstr("has usually fx 575.8")) << "its colour camera";
  EXPECT_THAT(refused(told, camera(610)), HasSubstr("more than 5 % away"));
  EXPECT_EQ(refused({.name = "another", .serial = {}, .clock = {}}, camera(100)), "") << "it says nothing";
}

TEST(DeviceSays, AnotherUnitIsRefused) {
  const std::vector<std::uint16_t> pixels(640 * 480);
  RigCamera wanted;
  EXPECT_EQ(test::thrown_message([&] { refuse_other_unit(depth_view(pixels, 640, 480, 0.001), wanted); }), "");
  EXPECT_EQ(test::thrown_message([&] { refuse_other_unit(depth_view(pixels, 640, 480, 0.0001), wanted); }),
            "gives depth in units of 0.0001 m, the cell says 0.001: metres_per_unit: 0.0001");
}

}  // namespace
}  // namespace depthgrid::monitor
