// Calibrations in camera_info messages: both conventions of pixels, every model, and what is refused.
#include "depthgrid/messages/camera_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/thrown_message.hpp"

namespace depthgrid::messages {
namespace {

CameraModel wide_camera() {
  return {.intrinsics = from_opencv(640, 480, 525, 526, 319.5, 239.25),
          .distortion = make_distortion(Distortion::Model::rational,
                                        std::vector<double>{0.9, 0.12, 4e-4, -3e-4, 0.004, 1.23, 0.33, 0.018})};
}

bool equal(const CameraModel& a, const CameraModel& b) {
  return a.intrinsics.width_px == b.intrinsics.width_px && a.intrinsics.height_px == b.intrinsics.height_px &&
         a.intrinsics.fx_px == b.intrinsics.fx_px && a.intrinsics.fy_px == b.intrinsics.fy_px &&
         a.intrinsics.cx_px == b.intrinsics.cx_px && a.intrinsics.cy_px == b.intrinsics.cy_px &&
         distorts(a.distortion) == distorts(b.distortion) && a.distortion.coefficients == b.distortion.coefficients;
}

TEST(CameraInfoMessage, CountsPixelsFromTheFirstOnesCentre) {
  const CameraInfo info = camera_info(wide_camera(), {});
  EXPECT_EQ(info.k[2], 319.5);
  EXPECT_EQ(info.k[5], 239.25);
  EXPECT_EQ(camera_model(info, false).intrinsics.cx_px, 320.0);
}

TEST(CameraInfoMessage, ComesBackWithEveryLens) {
  CameraModel camera = wide_camera();
  EXPECT_TRUE(equal(camera_model(camera_info(camera, {}), false), camera));
  camera.distortion = make_distortion(Distortion::Model::equidistant, std::vector<double>{0.01, 0.02, 0, 0});
  EXPECT_TRUE(equal(camera_model(camera_info(camera, {}), false), camera));
  camera.distortion = make_distortion(Distortion::Model::plumb_bob, std::vector<double>{-0.1, 0.02, 1e-3, 0, 0.1});
  EXPECT_TRUE(equal(camera_model(camera_info(camera, {}), false), camera));
  camera.distortion = {};
  EXPECT_TRUE(equal(camera_model(camera_info(camera, {}), false), camera));
}

TEST(CameraInfoMessage, OfRectifiedImagesPCounts) {
  CameraInfo info = camera_info(wide_camera(), {});
  info.p = {400, 0, 310, 0, 0, 401, 230, 0, 0, 0, 1, 0};
  const CameraModel camera = camera_model(info, true);
  EXPECT_FALSE(distorts(camera.distortion));
  EXPECT_EQ(camera.intrinsics.fx_px, 400);
  EXPECT_EQ(camera.intrinsics.fy_px, 401);
  EXPECT_EQ(camera.intrinsics.cx_px, 310.5);
}

TEST(CameraInfoMessage, RefusesWithTheReason) {
  const auto why = [](const std::function<void(CameraInfo&)>& change, bool rectified = false) {
    CameraInfo info = camera_info(wide_camera(), {});
    change(info);
    return test::thrown_message([&] { static_cast<void>(camera_model(info, rectified)); });
  };
  EXPECT_EQ(why([](CameraInfo&) {}), "");
  EXPECT_EQ(why([](CameraInfo& i) { i.k.fill(0); }),
            "camera_info: K is all 0: the camera is not calibrated; give a rig file");
  EXPECT_EQ(why([](CameraInfo& i) { i.k[1] = 0.5; }),
            "camera_info: K[1] is 0.5, must be 0: rows fx 0 cx, 0 fy cy, 0 0 1");
  EXPECT_EQ(why([](CameraInfo& i) { i.k[8] = 2; }), "camera_info: K[8] is 2, must be 1: rows fx 0 cx, 0 fy cy, 0 0 1");
  EXPECT_EQ(why([](CameraInfo& i) { i.p[3] = -20; }, true),
            "camera_info: P shifts the rectified image out of its frame (Tx -20, Ty 0), must be 0; give a rig file");
  EXPECT_EQ(why([](CameraInfo& i) { i.r = {0, -1, 0, 1, 0, 0, 0, 0, 1}; }, true),
            "camera_info: R turns the rectified image out of its frame, must be the identity; give a rig file");
  EXPECT_EQ(why([](CameraInfo& i) { i.r.fill(0); }, true), "") << "not set";
  EXPECT_EQ(why([](CameraInfo& i) { i.p[3] = -20; }), "") << "images as the sensor has them";
  EXPECT_EQ(why([](CameraInfo& i) { i.p[4] = 1; }, true),
            "camera_info: P[4] is 1, must be 0: rows fx 0 cx Tx, 0 fy cy Ty, 0 0 1 0");
  EXPECT_EQ(why([](CameraInfo& i) { i.distortion_model = "omni\x1b"; }),
            "camera_info: distortion_model is 'omni\\x1b', must be plumb_bob, rational_polynomial or equidistant");
  EXPECT_THAT(why([](CameraInfo& i) { i.d.resize(3); }), ::testing::StartsWith("camera_info: D: "));
  EXPECT_THAT(why([](CameraInfo& i) { i.binning_x = 2; }), ::testing::HasSubstr("binning is 2 x 0"));
  EXPECT_THAT(why([](CameraInfo& i) { i.roi.y_offset = 4; }), ::testing::HasSubstr("roi begins at 0, 4"));
  EXPECT_THAT(why([](CameraInfo& i) { i.width = 4000000000U; }), ::testing::HasSubstr("4000000000 x 480"));
  EXPECT_THAT(why([](CameraInfo& i) { i.k[0] = std::nan(""); }), ::testing::StartsWith("camera_info"));
}

}  // namespace
}  // namespace depthgrid::messages
