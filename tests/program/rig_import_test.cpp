// Calibrations of other programs: the numbers that arrive, what is asked for, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "depthgrid/core/plausibility.hpp"
#include "program/rig/imported_camera.hpp"
#include "program/rig/rig_options.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {
namespace {

using testing::AllOf;
using testing::HasSubstr;

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::string import_message(const std::string& text, const ImportOptions& options = {}) {
  return message_of([&] { (void)import_cameras(text, "a/left.yaml", options); });
}

constexpr const char* kCameraInfo = R"(image_width: 640
image_height: 480
camera_name: front
camera_matrix:
  rows: 3
  cols: 3
  data: [525.5, 0, 319.5, 0, 526.25, 239.25, 0, 0, 1]
distortion_model: MODEL
distortion_coefficients:
  rows: 1
  cols: 5
  data: COEFFICIENTS
projection_matrix:
  rows: 3
  cols: 4
  data: [500, 0, 320, 0, 0, 501, 240, 0, 0, 0, 1, 0]
)";

std::string camera_info(const std::string& model, const std::string& coefficients) {
  std::string text = kCameraInfo;
  text.replace(text.find("MODEL"), 5, model);
  return text.replace(text.find("COEFFICIENTS"), 12, coefficients);
}

TEST(RigImport, RosCameraInfoFiles) {
  const auto cameras = import_cameras(camera_info("plumb_bob", "[0.1, -0.2, 0.001, 0.002, 0.03]"), "a/left.yaml", {});
  ASSERT_EQ(cameras.size(), 1U);
  const ImportedCamera& camera = cameras[0];
  EXPECT_EQ(camera.id, "front");
  EXPECT_EQ(camera.intrinsics.width_px, 640);
  EXPECT_EQ(camera.intrinsics.height_px, 480);
  EXPECT_EQ(camera.intrinsics.fx_px, 525.5);
  EXPECT_EQ(camera.intrinsics.fy_px, 526.25);
  EXPECT_EQ(camera.intrinsics.cx_px, 320.0);  // half a pixel more than from the pixel's centre
  EXPECT_EQ(camera.intrinsics.cy_px, 239.75);
  EXPECT_EQ(camera.distortion.model, Distortion::Model::plumb_bob);
  EXPECT_EQ(camera.distortion.coefficients, (std::array<double, 8>{0.1, -0.2, 0.001, 0.002, 0.03, 0, 0, 0}));
  EXPECT_FALSE(camera.T_world_camera.has_value());
}

TEST(RigImport, RosDistortionModels) {
  const auto lens = [](const std::string& model, const std::string& k) {
    return import_cameras(camera_info(model, k), "left.yaml", {})[0].distortion;
  };
  const Distortion rational = lens("rational_polynomial", "[0.1, 0.02, 0.001, 0.002, 0.01, 0.3, 0.02, 0.01]");
  EXPECT_EQ(rational.model, Distortion::Model::rational);
  EXPECT_EQ(rational.coefficients[5], 0.3);
  EXPECT_EQ(lens("equidistant", "[0.01, 0.02, -0.003, 0.0004]").model, Distortion::Model::equidistant);
  EXPECT_EQ(lens("equidistant", "[0, 0, 0, 0]").model, Distortion::Model::equidistant) << "still a fisheye";
  EXPECT_EQ(lens("plumb_bob", "[0, 0, 0, 0, 0]").model, Distortion::Model::none);
  EXPECT_EQ(lens("plumb_bob", "[]").model, Distortion::Model::none);
  EXPECT_EQ(lens("rational_polynomial", "[0.1, 0.02, 0, 0, 0.01]").model, Distortion::Model::plumb_bob);
  EXPECT_EQ(lens("rational_polynomial", "[0.1, 0.02, 0, 0, 0.01, 0.2, 0, 0, 0, 0, 0, 0, 0, 0]").model,
            Distortion::Model::rational);
  EXPECT_THAT(import_message(camera_info("thin_prism", "[1]")),
              AllOf(HasSubstr("a/left.yaml: distortion model 'thin_prism' is not known"), HasSubstr("equidistant")));
  EXPECT_THAT(import_message(camera_info("plumb_bob", "[1, 2, 3]")), HasSubstr("3 coefficients given, must be 4 or 5"));
}

TEST(RigImport, RosMessagesAsPrintedAndRectifiedImages) {
  const std::string message =
      "header:\n  stamp: {sec: 1, nanosec: 2}\n  frame_id: depth_optical\nheight: 480\nwidth: 640\n"
      "distortion_model: plumb_bob\nd:\n- 0.1\n- 0.2\n- 0.0\n- 0.0\n- 0.0\nk:\n- 525.0\n- 0.0\n- 319.5\n- 0.0\n- "
      "525.0\n"
      "- 239.5\n- 0.0\n- 0.0\n- 1.0\np: [500, 0, 310, 0, 0, 501, 230, 0, 0, 0, 1, 0]\nbinning_x: 0\nbinning_y: 0\n"
      "roi:\n  x_offset: 0\n  y_offset: 0\n---\nheight: 1\n";
  const ImportedCamera raw = import_cameras(message, "m.yaml", {})[0];
  EXPECT_EQ(raw.id, "depth_optical");
  EXPECT_EQ(raw.intrinsics.fx_px, 525.0);
  EXPECT_EQ(raw.distortion.coefficients[1], 0.2);
  const ImportedCamera rectified = import_cameras(message, "m.yaml", {.rectified = true, .depth_mode = {}})[0];
  EXPECT_EQ(rectified.intrinsics.fx_px, 500.0);
  EXPECT_EQ(rectified.intrinsics.cx_px, 310.5);
  EXPECT_EQ(rectified.intrinsics.fy_px, 501.0);
  EXPECT_EQ(rectified.distortion.model, Distortion::Model::none);
  std::string part = message;
  part.replace(part.find("x_offset: 0"), 11, "x_offset: 8");
  EXPECT_THAT(import_message(part), HasSubstr("roi/x_offset: images are a part of the sensor's"));
  part = message;
  part.replace(part.find("binning_x: 0"), 12, "binning_x: 2");
  EXPECT_THAT(import_message(part), HasSubstr("binning_x: images are binned"));
}

constexpr const char* kChain = R"(cam0:
  camera_model: pinhole
  intrinsics: [285.5, 286.25, 319.25, 243.5]
  distortion_model: equidistant
  distortion_coeffs: [-0.008, 0.043, -0.04, 0.007]
  resolution: [640, 480]
cam1:
  T_cn_cnm1:
  - [0.0, -1.0, 0.0, -0.4]
  - [1.0, 0.0, 0.0, 0.1]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  intrinsics: [461.5, 460.25, 362.75, 246.0]
  distortion_model: radtan
  distortion_coeffs: [-0.27, 0.067, 0.0008, 0.0001]
  resolution: [752, 480]
cam2:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.5]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  intrinsics: [461.5, 460.25, 362.75, 246.0]
  distortion_model: none
  resolution: [752, 480]
)";

RigOptions told() {
  RigOptions options;
  options.metres_per_unit = {"0.001"};
  options.sensors = {"none"};
  options.output = "cell.json";
  return options;
}

TEST(RigImport, KalibrChainsGiveEveryCameraItsPlace) {
  const auto cameras = import_cameras(kChain, "camchain.yaml", {});
  ASSERT_EQ(cameras.size(), 3U);
  EXPECT_EQ(cameras[0].distortion.model, Distortion::Model::equidistant);
  EXPECT_EQ(cameras[1].distortion.model, Distortion::Model::plumb_bob);
  EXPECT_EQ(cameras[2].distortion.model, Distortion::Model::none);
  EXPECT_EQ(cameras[1].intrinsics.width_px, 752);
  RigOptions options = told();
  options.poses = {"cam0=1,2,3,0,0,0,1"};
  const files::RigFile file = make_rig(cameras, options);
  // A point in each camera's frame, by the chain's own words: p_cn = T_cn_cnm1 p_cnm1.
  const Eigen::Vector3d p_cam0(0.3, -0.2, 2);
  const Eigen::Vector3d p_cam1(0.2 - 0.4, 0.3 + 0.1, 2);
  const Eigen::Vector3d p_cam2 = p_cam1 + Eigen::Vector3d(-0.5, 0, 0);
  const Eigen::Vector3d p_world = p_cam0 + Eigen::Vector3d(1, 2, 3);
  EXPECT_LT((file.rig.cameras[0].T_world_camera * p_cam0 - p_world).norm(), 1e-12);
  EXPECT_LT((file.rig.cameras[1].T_world_camera * p_cam1 - p_world).norm(), 1e-12);
  EXPECT_LT((file.rig.cameras[2].T_world_camera * p_cam2 - p_world).norm(), 1e-12);
  options.poses = {"cam0=identity", "cam1=identity"};
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr("its chain says where it stands"));
  std::string gap = kChain;
  gap.replace(gap.find("cam1"), 4, "cam3");
  EXPECT_THAT(import_message(gap), HasSubstr("a/left.yaml: has 'cam2' but no 'cam1'"));
  std::string broken = kChain;
  broken.replace(broken.find("640, 480"), 8, "640.7, 480");
  EXPECT_THAT(import_message(broken), HasSubstr("cam0/resolution/0: 640.7 must be a whole number"));
  broken = kChain;
  broken.replace(broken.find("640, 480"), 8, "640");
  EXPECT_THAT(import_message(broken), HasSubstr("cam0/resolution: has 1 numbers, must have 2"));
  std::string omni = kChain;
  omni.replace(omni.find("pinhole"), 7, "omni");
  EXPECT_THAT(import_message(omni), HasSubstr("cam0/camera_model: 'omni' is not read, must be pinhole"));
}

TEST(RigImport, Open3dIntrinsicsParametersAndTrajectories) {
  const std::string intrinsic =
      R"({"width": 640, "height": 480, "intrinsic_matrix": [525.0, 0, 0, 0, 526.0, 0, 319.5, 239.5, 1]})";
  const ImportedCamera plain = import_cameras(intrinsic, "d/depth.json", {})[0];
  EXPECT_EQ(plain.id, "depth");
  EXPECT_EQ(plain.intrinsics.fy_px, 526.0);
  EXPECT_EQ(plain.intrinsics.cx_px, 320.0);
  EXPECT_EQ(plain.intrinsics.cy_px, 240.0);
  EXPECT_FALSE(plain.T_world_camera.has_value());
  // Columns of the transform from world to camera.
  const std::string parameters =
      R"({"class_name": "PinholeCameraParameters", "extrinsic": [1,0,0,0, 0,1,0,0, 0,0,1,0, -0.5,0.25,3,1], "intrinsic": )" +
      intrinsic + "}";
  const ImportedCamera placed = import_cameras(parameters, "view.json", {})[0];
  ASSERT_TRUE(placed.T_world_camera.has_value());
  EXPECT_LT((placed.T_world_camera->translation() - Eigen::Vector3d(0.5, -0.25, -3)).norm(), 1e-12);
  const auto both = import_cameras("{\"parameters\": [" + parameters + ", " + parameters + "]}", "t.json", {});
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[1].id, "t1");
  EXPECT_THAT(import_message(R"({"width": 640, "height": 480, "intrinsic_matrix": [525,0,319.5, 0,525,239.5, 0,0,1]})"),
              HasSubstr("intrinsic_matrix: must be columns fx 0 0, 0 fy 0, cx cy 1; are these rows?"));
  EXPECT_THAT(import_message(R"({"width": 640, "height": 480, "intrinsic_matrix": [525,2,0, 0,525,0, 319.5,239.5,1]})"),
              HasSubstr("must be columns"));
}

/// A matrix of columns, or with a skew: its numbers are not those that are taken from there.
TEST(RigImport, RosMatricesOfAnotherFormAreRefused) {
  const std::string good = camera_info("plumb_bob", "[0, 0, 0, 0]");
  const auto with = [&good](const std::string& old, const std::string& other) {
    std::string text = good;
    return text.replace(text.find(old), old.size(), other);
  };
  const std::string k = "525.5, 0, 319.5, 0, 526.25, 239.25, 0, 0, 1";
  const std::string p = "500, 0, 320, 0, 0, 501, 240, 0, 0, 0, 1, 0";
  for (const std::string other :
       {"525.5, 0, 0, 0, 526.25, 0, 319.5, 239.25, 1", "525.5, 3, 319.5, 0, 526.25, 239.25, 0, 0, 1",
        "525.5, 0, 319.5, 0, 526.25, 239.25, 0, 0, 2", "0, 0, 0, 0, 0, 0, 0, 0, 0"}) {
    EXPECT_THAT(import_message(with(k, other)),
                HasSubstr("a/left.yaml: camera_matrix/data: must be rows fx 0 cx, 0 fy cy, 0 0 1"));
  }
  const ImportOptions rectified{.rectified = true, .depth_mode = {}};
  EXPECT_EQ(import_message(with(p, "500, 0, 320, -60, 0, 501, 240, 0, 0, 0, 1, 0"), rectified), "") << "the right one";
  EXPECT_THAT(import_message(with(p, "500, 0, 0, 0, 501, 0, 320, 240, 1, 0, 0, 0"), rectified),
              HasSubstr("projection_matrix/data: must be rows"));
}

TEST(RigImport, NumbersThatNoCameraHasNameTheFile) {
  std::string text = camera_info("plumb_bob", "[0, 0, 0, 0]");
  EXPECT_THAT(import_message(text.replace(text.find("525.5"), 5, "0.525")),
              HasSubstr("a/left.yaml: camera 'front': fx is 0.525 px"));
  const std::string far =
      R"({"extrinsic": [1,0,0,0, 0,1,0,0, 0,0,1,0, -500,250,3000,1], "intrinsic": {"width": 640, "height": 480, )"
      R"("intrinsic_matrix": [525.0, 0, 0, 0, 526.0, 0, 319.5, 239.5, 1]}})";
  EXPECT_THAT(import_message(far), AllOf(HasSubstr("a/left.yaml: camera 'left': translation is (500, -250, -3000) m"),
                                         HasSubstr("in millimetres?")));
}

TEST(RigImport, BrokenOptionsAreBrokenCommandLines) {
  const auto cameras = import_cameras(camera_info("plumb_bob", "[]"), "left.yaml", {});
  struct Case {
    std::string scale, pose, message;
  };
  for (const Case& broken : {
           Case{"0.001,0.00025", "identity", "--metres-per-unit 0.001,0.00025: 2 numbers, must be 1"},
           Case{"1000", "identity", "--metres-per-unit: metres_per_unit is 1000"},
           Case{"0.001", "0,0,1200,0,0,0,1", "--pose 0,0,1200,0,0,0,1: translation is (0, 0, 1200) m"},
           Case{"0.001", "2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1", "--pose: rotation deviates"},
       }) {
    RigOptions options = told();
    options.metres_per_unit = {broken.scale};
    options.poses = {broken.pose};
    EXPECT_THROW((void)make_rig(cameras, options), UsageError) << broken.message;
    EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr(broken.message));
  }
}

TEST(RigImport, NumbersOfFramesAreAskedForWhereNamesHaveThem) {
  const auto cameras = import_cameras(camera_info("plumb_bob", "[]"), "left.yaml", {});
  RigOptions options = told();
  options.poses = {"identity"};
  options.depth_files = {"d/%04d.png"};
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr("give --frames FIRST:LAST"));
  options.depth_files = {"d/one.png"};
  EXPECT_EQ(make_rig(cameras, options).frame_count, 1);
}

std::string azure(const std::string& model, const std::string& tangential = "6e-5,-9e-5") {
  return R"({"CalibrationInformation":{"Cameras":[{"Location":"CALIBRATION_CameraLocationPV0"},{"Intrinsics":{"ModelParameters":)"
         "[0.51,0.5,0.4935,0.4937,0.436,0.068,0.0044,0.773,0.148,0.02,0,0," +
         tangential + R"(],"ModelType":"CALIBRATION_LensDistortionModel)" + model +
         R"("},"Location":"CALIBRATION_CameraLocationD0","SensorHeight":1024,"SensorWidth":1024}]}})";
}

TEST(RigImport, AzureKinectCalibrationsOfEveryDepthMode) {
  const auto camera = [](const std::string& mode) {
    return import_cameras(azure("BrownConrady"), "k4a.json", {.rectified = false, .depth_mode = mode})[0];
  };
  const ImportedCamera wide = camera("wfov_2x2binned");
  EXPECT_EQ(wide.intrinsics.width_px, 512);
  EXPECT_NEAR(wide.intrinsics.fx_px, 0.4935 * 512, 1e-9);
  EXPECT_NEAR(wide.intrinsics.cx_px, 0.51 * 512, 1e-9);  // counted from the corner, in the file and here
  EXPECT_EQ(wide.distortion.model, Distortion::Model::rational);
  // k1 k2 p1 p2 k3 k4 k5 k6, the file has p2 before p1
  EXPECT_EQ(wide.distortion.coefficients,
            (std::array<double, 8>{0.436, 0.068, -9e-5, 6e-5, 0.0044, 0.773, 0.148, 0.02}));
  const ImportedCamera narrow = camera("nfov_unbinned");
  EXPECT_EQ(narrow.intrinsics.width_px, 640);
  EXPECT_EQ(narrow.intrinsics.height_px, 576);
  EXPECT_NEAR(narrow.intrinsics.cx_px, 0.51 * 1024 - 192, 1e-9);
  EXPECT_NEAR(narrow.intrinsics.cy_px, 0.5 * 1024 - 180, 1e-9);
  EXPECT_THAT(import_message(azure("BrownConrady")),
              AllOf(HasSubstr("does not say which depth mode"), HasSubstr("--depth-mode nfov_unbinned (640 x 576)")));
  // The other model multiplies p1 and p2 otherwise.
  EXPECT_THAT(import_message(azure("Rational6KT"), {false, "nfov_unbinned"}), HasSubstr("is not known"));
  EXPECT_EQ(import_message(azure("Rational6KT", "0,0"), {false, "nfov_unbinned"}), "");
}

TEST(RigImport, OptionsWithoutEffectAreRefused) {
  const ImportOptions rectified{.rectified = true, .depth_mode = "nfov_unbinned"};
  const std::string open3d =
      R"({"width": 640, "height": 480, "intrinsic_matrix": [525.0, 0, 0, 0, 526.0, 0, 319.5, 239.5, 1]})";
  for (const auto& [text, format] : {std::pair(std::string(kChain), "Kalibr camchain"), std::pair(open3d, "Open3D"),
                                     std::pair(azure("BrownConrady"), "Azure Kinect, nfov_unbinned")}) {
    EXPECT_EQ(import_message(text, rectified),
              std::string("--rectified has no effect: it is for a ROS camera_info, and a/left.yaml is ") + format);
    EXPECT_THROW((void)import_cameras(text, "f", rectified), UsageError);
  }
  RigOptions options = told();
  options.poses = {"identity"};
  options.import.depth_mode = "nfov_unbinned";
  const auto cameras = import_cameras(open3d, "f.json", options.import);
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr("--depth-mode has no effect"));
  EXPECT_THROW((void)make_rig(cameras, options), UsageError);
  const auto kinect = import_cameras(azure("BrownConrady"), "k.json", options.import);
  EXPECT_EQ(message_of([&] { (void)make_rig(kinect, options); }), "");
}

TEST(RigImport, ByteOrderMarksAndWindowsLinesAndOpencvHeaders) {
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : camera_info("plumb_bob", "[0, 0, 0, 0]")) {
    windows += c == '\n' ? "\r\n" : std::string(1, c);
  }
  EXPECT_EQ(import_cameras(windows, "w.yaml", {})[0].id, "front");
  EXPECT_EQ(
      import_cameras("%YAML:1.0\n---\n" + camera_info("plumb_bob", "!!opencv-matrix [0, 0, 0, 0]"), "o.yaml", {})[0].id,
      "front");
  EXPECT_THAT(import_message(std::string("\xFF\xFE{\0", 4)), HasSubstr("UTF-16"));
}

TEST(RigImport, HostileAndBrokenTextsAreRefused) {
  EXPECT_THAT(import_message("a: &a [1]\nb: [*a, *a]\n"), HasSubstr("a/left.yaml: line 2: YAML aliases"));
  EXPECT_THAT(import_message(std::string(100, '[')), HasSubstr("nested deeper than 32 levels"));
  EXPECT_THAT(import_message(std::string((1 << 20) + 1, ' ')), HasSubstr("must have at most 1048576"));
  std::string many = "[";
  for (int i = 0; i < 250'000; ++i) {
    many += "1,";
  }
  EXPECT_THAT(import_message(many + "]"), HasSubstr("more than 200000 values"));
  EXPECT_THAT(import_message("a: [1, 2"), HasSubstr("no YAML or JSON"));
  EXPECT_THAT(import_message("cam0: {camera_model: pinhole\xa9}\n"),
              HasSubstr("cam0/camera_model: 'pinhole?' holds a control character or a byte that is no UTF-8"));
  for (const std::string text : {"a: \"\\\n", "camera_name: \"a\\nb\"\nk: [1]\nwidth: 8\nheight: 8\n"}) {
    const std::string message = import_message(text);  // two lines in, one out
    EXPECT_NE(message, "");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_THAT(import_message(""), HasSubstr("is no calibration that is known here"));
  EXPECT_THAT(import_message("x: 1"), AllOf(HasSubstr("camera_matrix"), HasSubstr("cam0"),
                                            HasSubstr("intrinsic_matrix"), HasSubstr("CalibrationInformation")));
  EXPECT_THAT(import_message(R"({"cameras": []})"), HasSubstr("is a rig file already"));
  std::string text = camera_info("plumb_bob", "[0, 0, .nan, 0]");
  EXPECT_THAT(import_message(text), HasSubstr("distortion_coefficients/data/2: '.nan' must be a finite number"));
  text = camera_info("plumb_bob", "[0, 0, 0, 0]");
  EXPECT_THAT(import_message(text.replace(text.find("image_width: 640"), 16, "image_width: 6.5")),
              HasSubstr("image_width: 6.5 must be a whole number"));
}

TEST(RigImport, WhatFilesDoNotSayIsAskedForInOneMessage) {
  const auto cameras = import_cameras(camera_info("plumb_bob", "[]"), "left.yaml", {});
  RigOptions nothing;
  nothing.output = "rig.json";
  EXPECT_EQ(
      message_of([&] { (void)make_rig(cameras, nothing); }),
      "the files do not say everything, give --metres-per-unit M (metres of one unit of the 16-bit images, 0.001 "
      "for millimetres); --pose front=x,y,z,qx,qy,qz,qw (where the camera stands in the world; identity: the world "
      "is its frame); --sensor NAME (its range and errors, docs/sensor-models.md; none: state them later)");
  EXPECT_THROW((void)make_rig(cameras, nothing), UsageError);
}

TEST(RigImport, OptionsForAllAndForOne) {
  auto cameras = import_cameras(camera_info("plumb_bob", "[]"), "left.yaml", {});
  cameras.push_back(cameras[0]);
  RigOptions options = told();
  options.poses = {"a=identity", "b=0,0,1,0,0,0.7071068,0.7071068"};
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr("two cameras are called 'front'"));
  options.ids = {"a", "b"};
  options.metres_per_unit = {"b=0.0001", "0.001"};
  options.sensors = {"realsense_d435", "b=none"};
  options.depth_files = {"a=a/%03d.png", "b=b/%03d.png"};
  options.frames = "3:12";
  const files::RigFile file = make_rig(cameras, options);
  EXPECT_EQ(file.rig.cameras[0].metres_per_unit, 0.001);
  EXPECT_EQ(file.rig.cameras[1].metres_per_unit, 0.0001);
  EXPECT_EQ(file.rig.cameras[0].sensor, "realsense_d435");
  EXPECT_EQ(file.rig.cameras[0].rule.far_m, 3.0);
  EXPECT_FALSE(file.rig.cameras[1].margins.has_value());
  EXPECT_NEAR(file.rig.cameras[1].T_world_camera.linear()(1, 0), 1.0, 1e-6);
  EXPECT_EQ(file.depth_files[1], "b/%03d.png");
  EXPECT_EQ(file.first_frame, 3);
  EXPECT_EQ(file.frame_count, 10);
  EXPECT_EQ(files::parse_rig(files::to_json(file), "written").rig.cameras.size(), 2U);
  options.poses = {"c=identity"};
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }),
              HasSubstr("there is no camera 'c', there are a, b"));
  options.poses = {"identity"};
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr("write --pose ID="));
  cameras.pop_back();
  options.ids = {"a"};
  options.metres_per_unit = {"0.001"};
  options.sensors = {"none"};
  options.depth_files = {};
  options.poses = {"1,2,3"};
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr("3 numbers, must be 7"));
  options.poses = {"0,0,0,0,0,0,2"};
  EXPECT_THAT(message_of([&] { (void)make_rig(cameras, options); }), HasSubstr("has length 2, must be 1"));
}

}  // namespace
}  // namespace depthgrid::program
