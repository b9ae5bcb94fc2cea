// Numbers of a calibration in the wrong unit are refused, and the message says what was probably meant.
#include "depthgrid/core/plausibility.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/core/text_encoding.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string of_camera(const PinholeCamera& camera, const Distortion& lens = {}) {
  return test::thrown_message([&] { check_plausible(camera, lens); });
}

TEST(Plausibility, RealCamerasPass) {
  for (const PinholeCamera& camera : {PinholeCamera{640, 480, 525, 525, 320, 240},
                                      {1280, 720, 640, 639, 641, 362},
                                      {640, 576, 504, 504.25, 321, 333.5},
                                      {320, 288, 252, 252, 160, 167},
                                      {1024, 1024, 505, 505, 512, 520},
                                      {8, 6, 10, 11, 4, 2.75}}) {
    EXPECT_EQ(of_camera(camera), "") << camera.width_px;
  }
}

TEST(Plausibility, FocalLengthsInOtherUnits) {
  EXPECT_THAT(of_camera({640, 480, 0.6, 525, 320, 240}),
              AllOf(HasSubstr("camera: fx is 0.6 px in an image of width 640 px, a field of view of 179.78"),
                    HasSubstr("did you mean 384")));
  EXPECT_THAT(of_camera({640, 480, 525, 0.8, 320, 240}), HasSubstr("did you mean 384"));
  EXPECT_THAT(of_camera({640, 480, 0.00193, 525, 320, 240}), HasSubstr("is it in millimetres or metres?"));
  EXPECT_THAT(of_camera({640, 480, 6, 6, 320, 240}), HasSubstr("needed are pixels"));
  EXPECT_THAT(of_camera({640, 480, 525000, 525, 320, 240}), HasSubstr("must be 2 to 175"));
  EXPECT_THAT(of_camera({640, 480, 525, 100, 320, 240}), HasSubstr("pixels are nearly square"));
}

TEST(Plausibility, PrincipalPointsOutsideOrDividedBySize) {
  EXPECT_THAT(of_camera({640, 480, 525, 525, 3200, 240}),
              AllOf(HasSubstr("cx is 3199.5 px"), HasSubstr("half the width would be 319.5")));
  EXPECT_THAT(of_camera({640, 480, 525, 525, 320, -700}), HasSubstr("cy is -700.5 px"));
  EXPECT_THAT(of_camera({640, 480, 525, 525, 1.0, 1.0}),
              AllOf(HasSubstr("cx, cy is 0.5, 0.5"), HasSubstr("319.5, 239.5")));
}

TEST(Plausibility, DistortionOfAnotherModelOrOrder) {
  const PinholeCamera camera{640, 480, 525, 525, 320, 240};
  const auto plumb_bob = [](const std::vector<double>& k) { return make_distortion(Distortion::Model::plumb_bob, k); };
  EXPECT_EQ(of_camera(camera, plumb_bob({-0.3, 0.1, 0.001, 0, 0})), "");
  EXPECT_THAT(of_camera(camera, plumb_bob({0.1, 0.1, 2.5, 0.1, 0})), HasSubstr("the order is k1 k2 p1 p2 k3"));
  EXPECT_THAT(of_camera(camera, plumb_bob({-30, 0, 0, 0, 0})), HasSubstr("the coefficients fold back 37 px"));
  EXPECT_THAT(of_camera(camera, make_distortion(Distortion::Model::equidistant, std::vector<double>{-0.6, 0, 0, 0})),
              HasSubstr("degrees off the axis"));
  // Thousandths of what they should be: then the image shows no more than its middle.
  EXPECT_THAT(of_camera(camera, plumb_bob({100, 0, 0, 0, 0})), HasSubstr("shows less than 8.6"));
  EXPECT_THAT(of_camera(camera, make_distortion(Distortion::Model::equidistant, std::vector<double>{200, 0, 0, 0})),
              HasSubstr("the image's border shows less than"));
  EXPECT_EQ(of_camera(camera, plumb_bob({0.8, 0.5, 0, 0, 0})), "") << "more than any lens bends outwards";
  // 0.1 everywhere, as in a file that only shows the form, folds nowhere near the image.
  EXPECT_EQ(of_camera(camera, make_distortion(Distortion::Model::rational, std::vector<double>(8, 0.1))), "");
}

TEST(Plausibility, Scales) {
  const auto message = [](double scale) { return test::thrown_message([&] { check_plausible_scale(scale); }); };
  for (const double good : {0.001, 0.0001, 0.00025, 0.0002, 0.00012498664727900177, 0.01, 1e-5}) {
    EXPECT_EQ(message(good), "");
  }
  EXPECT_THAT(message(1000), HasSubstr("did you mean 0.001"));
  EXPECT_THAT(message(5000), HasSubstr("did you mean 0.0002"));
  EXPECT_THAT(message(1), HasSubstr("did you mean 0.001"));
  EXPECT_THAT(message(0.1), HasSubstr("did you mean 0.001"));
  EXPECT_THAT(message(1e-9), HasSubstr("did you mean 0.001"));
}

TEST(Plausibility, RangesAndMarginsInMillimetresDegreesAndMilliseconds) {
  const auto range = [](double near_m, double far_m) {
    return test::thrown_message([&] { check_plausible(MeasurementRule{near_m, far_m, false, {}}); });
  };
  EXPECT_EQ(range(0.28, 3), "");
  EXPECT_EQ(range(0, std::numeric_limits<double>::infinity()), "");
  EXPECT_EQ(range(280, 3000), "depth range: near is 280 m, must be at most 10 m; in millimetres? did you mean 0.28?");
  EXPECT_THAT(range(0.28, 3000), HasSubstr("did you mean 3?"));
  EXPECT_THAT(range(0, 0.003), HasSubstr("in kilometres?"));
  const auto margins = [](double CameraMargins::*part, double value) {
    CameraMargins changed;
    changed.*part = value;
    return test::thrown_message([&] { check_plausible(changed); });
  };
  EXPECT_EQ(margins(&CameraMargins::translation_m, 5),
            "margins: translation is 5 m, must be at most 1 m; in millimetres? did you mean 0.005?");
  EXPECT_THAT(margins(&CameraMargins::rotation_rad, 2), AllOf(HasSubstr("in degrees?"), HasSubstr("0.0349")));
  EXPECT_THAT(margins(&CameraMargins::half_exposure_s, 16), HasSubstr("did you mean 0.016?"));
  EXPECT_THAT(margins(&CameraMargins::time_uncertainty_s, 100), HasSubstr("did you mean 0.1?"));
  CameraMargins noise;
  noise.sensor = {12, 0, 0, 1};
  EXPECT_THAT(test::thrown_message([&] { check_plausible(noise); }), HasSubstr("did you mean 0.012?"));
  for (const SensorModel& model : sensor_models()) {
    check_plausible(sensor_margins(model, {640, 480, 380, 380, 320, 240}, 0.001));
    check_plausible(model.rule);
  }
}

TEST(Plausibility, PosesInMillimetres) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(350, -20.5, 900);
  EXPECT_EQ(test::thrown_message([&] { check_plausible(pose); }),
            "pose: translation is (350, -20.5, 900) m, no coordinate may be beyond 100 m; in millimetres? did you mean "
            "(0.35, -0.0205, 0.9)? if not, move the world's origin near the cameras");
  Pose other = Pose::Identity();
  other.translation() = Eigen::Vector3d(0, 60, 0);
  check_plausible(other);
  EXPECT_EQ(test::thrown_message([&] {
              check_plausible_distances(std::vector{Pose(Pose::Identity()), other});
            }),
            "camera 0 stands 60 m from the nearest other one (1), must be at most 50 m; are the poses in millimetres? "
            "did you mean 0.06 m?");
  check_plausible_distances(std::vector{other});
}

TEST(Plausibility, MatricesThatAreNoRotation) {
  const auto message = [](const Eigen::Matrix3d& rotation) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = rotation;
    return test::thrown_message([&] { (void)pose_from_matrix(matrix); });
  };
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_EQ(message(turned), "");
  EXPECT_THAT(message(1000 * turned), HasSubstr("it is scaled by 1000"));
  EXPECT_THAT(message(Eigen::Matrix3d::Zero()), HasSubstr("not a rotation?"));
  EXPECT_THAT(message(Eigen::Vector3d(1, -1, 1).asDiagonal() * turned),
              HasSubstr("where y is up in camera and world (ICL-NUIM)"));
  // What the message advises is right: both mirrored is a rotation again.
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, -1, 1).asDiagonal();
  EXPECT_EQ(message(mirror * turned * mirror), "");
}

TEST(TextEncoding, MarksAreTakenOffAndOtherEncodingsNamed) {
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF{}", "f: "), "{}");
  EXPECT_EQ(without_byte_order_mark("{}", "f: "), "{}");
  EXPECT_EQ(without_byte_order_mark("", "f: "), "");
  for (const std::string& text : {std::string("\xFF\xFE{\0}\0", 6), std::string("\xFE\xFF\0{", 4),
                                  std::string("{\0}\0", 4), std::string("\0{", 2)}) {
    EXPECT_THAT(test::thrown_message([&] { (void)without_byte_order_mark(text, "f: "); }),
                HasSubstr("f: is UTF-16 or UTF-32 text, must be UTF-8"));
  }
}

}  // namespace
}  // namespace depthgrid
