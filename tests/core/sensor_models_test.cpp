// The built-in sensor models against the noise models that they stand for.
#include "depthgrid/core/sensor_models.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "depthgrid/core/rig.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid {
namespace {

PinholeCamera camera_of(double fx_px) { return {848, 480, fx_px, fx_px, 424.0, 240.0}; }

TEST(SensorModels, AreValidWithDistinctNames) {
  std::set<std::string_view> names;
  for (const SensorModel& model : sensor_models()) {
    EXPECT_TRUE(names.insert(model.name).second) << model.name;
    EXPECT_NO_THROW(validate(sensor_margins(model, camera_of(447), 0.001))) << model.name;
    EXPECT_NO_THROW(validate(model.rule)) << model.name;
    EXPECT_EQ(&sensor_model(model.name), &model);
  }
}

TEST(SensorModels, HyphensCountAsUnderscores) { EXPECT_EQ(sensor_model("kinect-v1").name, "kinect_v1"); }

TEST(SensorModels, UnknownNamesAreRefusedWithTheListOfThem) {
  EXPECT_EQ(test::thrown_message([] { (void)sensor_model("kinect"); }),
            "there is no sensor model 'kinect', known are ideal, kinect_v1, realsense_d415, realsense_d435, "
            "realsense_d455, azure_kinect_nfov, azure_kinect_nfov_binned, azure_kinect_wfov, azure_kinect_wfov_binned");
  EXPECT_NE(test::thrown_message([] { (void)sensor_model(""); }), "");
  EXPECT_NE(test::thrown_message([] { (void)sensor_model("kinect_v1 "); }), "");
}

TEST(SensorModels, IdealIsFreeOfErrors) {
  const SensorModel& ideal = sensor_model("ideal");
  const CameraMargins margins = sensor_margins(ideal, camera_of(447), 0.001);
  EXPECT_EQ(depth_margin_m(margins.sensor, 5.0), 0.0);
  EXPECT_EQ(margins.sensor.lateral_px, 1);
  EXPECT_EQ(margins.half_exposure_s, 0.0);
  EXPECT_EQ(ideal.rule.near_m, 0.0);
  EXPECT_EQ(ideal.rule.far_m, std::numeric_limits<double>::infinity());
}

TEST(SensorModels, KinectIsNeverBelowItsNoiseModelAndAtMost4Point3MillimetresAbove) {
  const SensorModel& kinect = sensor_model("kinect_v1");
  const CameraMargins margins = sensor_margins(kinect, camera_of(580), 0.001);
  double largest_excess_m = 0;
  for (double z = kinect.rule.near_m; z <= kinect.rule.far_m; z += 0.001) {
    const double sigma_m = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    const double model_m = kSensorSigmas * sigma_m + 0.5 * 2.9e-3 * z * z;
    const double margin_m = depth_margin_m(margins.sensor, z);
    ASSERT_GE(margin_m, model_m) << "z = " << z;
    largest_excess_m = std::max(largest_excess_m, margin_m - model_m);
  }
  EXPECT_LE(largest_excess_m, 0.0043);
  EXPECT_GE(largest_excess_m, 0.0040);
  EXPECT_TRUE(kinect.rule.clamp_beyond_far);
}

/// The disparity of a point moved by three standard deviations and half a step, from first principles.
TEST(SensorModels, RealSenseCoversThreeSigmaOfDisparity) {
  for (const double fx_px : {215.0, 447.0, 640.0}) {
    const CameraMargins margins = sensor_margins(sensor_model("realsense_d435"), camera_of(fx_px), 0.001);
    for (double z = 0.3; z <= 3.0; z += 0.1) {
      const double disparity_px = fx_px * 0.05 / z;
      const double error_px = 3 * 0.08 + 0.5 / 32;
      // A reading D that is too far by the error of its disparity: the surface stands at f b / (d + error).
      const double surface_m = fx_px * 0.05 / (disparity_px + error_px);
      EXPECT_GE(depth_margin_m(margins.sensor, z), z - surface_m + 0.02 * z + 0.0005) << fx_px << ", " << z;
      // f b / (d + e) >= z - z^2 e / (f b), and the difference is of second order.
      EXPECT_LE(depth_margin_m(margins.sensor, z),
                z - surface_m + 0.02 * z + 0.0005 + z * std::pow(error_px / disparity_px, 2))
          << fx_px << ", " << z;
    }
  }
}

TEST(SensorModels, RealSenseDependsOnTheCalibrationUpToItsLargestImage) {
  const SensorModel& d435 = sensor_model("realsense_d435");
  const auto at_2_m = [&](double fx_px, double unit_m) {
    return depth_margin_m(sensor_margins(d435, camera_of(fx_px), unit_m).sensor, 2.0);
  };
  EXPECT_GT(at_2_m(215, 0.001), at_2_m(447, 0.001));
  EXPECT_EQ(at_2_m(640, 0.001), at_2_m(2000, 0.001)) << "an enlarged image measures no better";
  EXPECT_NEAR(at_2_m(447, 0.001) - at_2_m(447, 0.0001), 0.00045, 1e-12) << "half a unit";
}

TEST(SensorModels, AzureKinectHasTheStatedErrorsInEveryMode) {
  for (const char* mode :
       {"azure_kinect_nfov", "azure_kinect_nfov_binned", "azure_kinect_wfov", "azure_kinect_wfov_binned"}) {
    const CameraMargins margins = sensor_margins(sensor_model(mode), camera_of(504), 0.001);
    EXPECT_NEAR(depth_margin_m(margins.sensor, 2.0), 3 * 0.017 + 0.011 + 0.001 * 2.0 + 0.0005, 1e-12) << mode;
  }
  EXPECT_EQ(sensor_model("azure_kinect_wfov").half_exposure_s, 0.0203 / 2);
  EXPECT_EQ(sensor_model("azure_kinect_nfov").rule.far_m, 3.86);
}

TEST(CameraMarginsOfARig, AreThoseOfItsCamerasOrAnError) {
  Rig rig;
  rig.name = "cell";
  rig.cameras.resize(2);
  rig.cameras[0].margins = CameraMargins{{}, 0.01, 0, 0, 0};
  rig.cameras[1].id = "right";
  EXPECT_EQ(test::thrown_message([&] { (void)camera_margins(rig); }),
            "rig 'cell': camera 'right' has no margins, so nothing is known of its errors; give its sensor (\"ideal\": "
            "none) or margins");
  rig.cameras[1].margins = CameraMargins{{}, 0.02, 0, 0, 0};
  ASSERT_EQ(camera_margins(rig).size(), 2U);
  EXPECT_EQ(camera_margins(rig)[1].translation_m, 0.02);
}

TEST(SensorOfACamera, NeedsMarginsAndAKnownName) {
  Rig rig;
  rig.name = "cell";
  rig.cameras.resize(1);
  RigCamera& camera = rig.cameras[0];
  camera.id = "left";
  camera.intrinsics = camera_of(447);
  const auto message = [&] { return test::thrown_message([&] { validate(rig); }); };
  EXPECT_EQ(message(), "");
  camera.sensor = "kinect_v1";
  EXPECT_EQ(message(),
            "camera 'left': has the sensor model 'kinect_v1' but no margins; take those of sensor_margins()");
  camera.margins = CameraMargins{};
  EXPECT_EQ(message(), "");
  camera.sensor = "kinect";
  EXPECT_THAT(message(), ::testing::StartsWith("camera 'left': there is no sensor model 'kinect', known are ideal, "));
  camera.sensor.clear();
  camera.margins->rotation_rad = -1;
  EXPECT_EQ(message(), "camera 'left': rotation is -1 rad, must be a finite number that is not negative");
}

}  // namespace
}  // namespace depthgrid
