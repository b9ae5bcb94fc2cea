// Rig files: what is loaded, in which convention, and that writing gives the same rig back.
#include "depthgrid/files/rig_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>

#include "depthgrid/core/sensor_models.hpp"
#include "files/rig_text.hpp"
#include "files/temporary_folder.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::small_rig;
using test::small_rig_with;
using test::TemporaryFolder;

TEST(RigFile, LoadsWhatStandsInTheFile) {
  const RigFile file = parse_rig(small_rig(), "rig.json");
  EXPECT_EQ(file.rig.name, "small");
  ASSERT_EQ(file.rig.cameras.size(), 2U);
  EXPECT_EQ(file.first_frame, 3);
  EXPECT_EQ(file.frame_count, 10);
  EXPECT_TRUE(file.simultaneous);
  EXPECT_EQ(file.rate_hz, 4.0);
  EXPECT_FALSE(file.rig.T_floor_world.has_value());
  const RigCamera& right = file.rig.cameras[1];
  EXPECT_EQ(right.id, "right");
  EXPECT_EQ(right.intrinsics.width_px, 8);
  EXPECT_EQ(right.intrinsics.height_px, 6);
  EXPECT_EQ(right.intrinsics.fx_px, 10);
  EXPECT_EQ(right.intrinsics.fy_px, 11);
  EXPECT_EQ(right.distortion.model, Distortion::Model::plumb_bob);
  EXPECT_EQ(right.rule.near_m, 0.25);
  EXPECT_EQ(right.rule.far_m, 4.0);
  EXPECT_TRUE(right.rule.clamp_beyond_far);
  EXPECT_EQ(file.depth_files, (std::vector<std::string>{"left/depth_%03d.png", "right/%03d.png"}));
}

TEST(RigFile, MovesThePrincipalPointToThePixelsEdge) {
  const RigFile file = parse_rig(small_rig(), "rig.json");
  EXPECT_EQ(file.rig.cameras[0].intrinsics.cx_px, 4.0);
  EXPECT_EQ(file.rig.cameras[0].intrinsics.cy_px, 2.75);
}

TEST(RigFile, PoseMapsCameraToWorld) {
  const RigFile file = parse_rig(small_rig(), "rig.json");
  const Eigen::Vector3d p_world = file.rig.cameras[1].T_world_camera * Eigen::Vector3d(0.1, 0.2, 3.0);
  EXPECT_TRUE(p_world.isApprox(Eigen::Vector3d(1.0, 0.2, 1.9), 1e-12)) << p_world.transpose();
}

TEST(RigFile, CamerasOwnScaleAndInvalidValuesWin) {
  const RigFile file = parse_rig(small_rig(), "rig.json");
  EXPECT_EQ(file.rig.cameras[0].metres_per_unit, 0.001);
  EXPECT_EQ(file.rig.cameras[0].rule.invalid_units, (std::vector<std::uint16_t>{0, 2047}));
  EXPECT_EQ(file.rig.cameras[1].metres_per_unit, 0.0005);
  EXPECT_TRUE(file.rig.cameras[1].rule.invalid_units.empty());
}

TEST(RigFile, SlightlyWrongRotationIsMadeOrthonormal) {
  const RigFile file =
      parse_rig(small_rig_with("[[1, 0, 0, 0.5], [0, 1, 0, 0]", "[[1.0004, 0, 0, 0.5], [0, 1, 0.0003, 0]"), "rig.json");
  const Eigen::Matrix3d rotation = file.rig.cameras[0].T_world_camera.linear();
  EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(file.rig.cameras[0].T_world_camera.translation().x(), 0.5);
}

TEST(RigFile, SensorGivesMarginsAndRangeWhereTheFileSaysNothing) {
  const RigFile file =
      parse_rig(small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"sensor\": \"kinect-v1\","), "rig");
  const RigCamera& left = file.rig.cameras[0];
  EXPECT_EQ(left.sensor, "kinect_v1");
  ASSERT_TRUE(left.margins.has_value());
  EXPECT_EQ(left.margins->sensor.quadratic_per_m, 0.00633);
  EXPECT_EQ(left.margins->sensor.lateral_px, 2);
  EXPECT_EQ(left.margins->translation_m, 0.0);
  EXPECT_EQ(left.rule.near_m, 0.5);
  EXPECT_EQ(left.rule.far_m, 5.0);
  EXPECT_TRUE(left.rule.clamp_beyond_far);
  EXPECT_EQ(left.rule.invalid_units, (std::vector<std::uint16_t>{0, 2047})) << "the file's own";
  EXPECT_FALSE(file.rig.cameras[1].margins.has_value());
  EXPECT_EQ(file.rig.cameras[1].sensor, "");
}

TEST(RigFile, SensorsMarginsFollowTheCalibration) {
  const RigFile file =
      parse_rig(small_rig_with("\"id\": \"right\",", "\"id\": \"right\", \"sensor\": \"realsense_d435\","), "rig");
  const SensorMargin& margin = file.rig.cameras[1].margins->sensor;
  EXPECT_DOUBLE_EQ(margin.quadratic_per_m, (3 * 0.08 + 0.5 / 32) / (10 * 0.05));
  EXPECT_EQ(margin.constant_m, 0.00025) << "half of the camera's own unit";
}

TEST(RigFile, OwnNumbersStandInPlaceOfTheSensors) {
  const RigFile file = parse_rig(
      small_rig_with("\"id\": \"left\",",
                     R"("id": "left", "sensor": "kinect_v1", "near_m": 0, "far_m": null, "clamp_beyond_far": false,
             "margins": {"noise_constant_m": 0.01, "noise_linear": 0.02, "noise_quadratic_per_m": 0.03, "lateral_px": 0,
             "translation_m": 0.04, "rotation_rad": 0.05, "half_exposure_s": 0.06, "time_uncertainty_s": 0.07,
             "smallest_obstacle_m": 0.08, "note": "a"},)"),
      "rig");
  const RigCamera& left = file.rig.cameras[0];
  EXPECT_EQ(left.margins->sensor.constant_m, 0.01);
  EXPECT_EQ(left.margins->sensor.linear, 0.02);
  EXPECT_EQ(left.margins->sensor.quadratic_per_m, 0.03);
  EXPECT_EQ(left.margins->sensor.lateral_px, 0);
  EXPECT_EQ(left.margins->translation_m, 0.04);
  EXPECT_EQ(left.margins->rotation_rad, 0.05);
  EXPECT_EQ(left.margins->half_exposure_s, 0.06);
  EXPECT_EQ(left.margins->time_uncertainty_s, 0.07);
  EXPECT_EQ(left.margins->smallest_obstacle_m, 0.08);
  EXPECT_EQ(left.rule.near_m, 0.0);
  EXPECT_EQ(left.rule.far_m, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(left.rule.clamp_beyond_far);
}

TEST(RigFile, TheSecondViewIsTheSensorsWhereImagesAreNotRegistered) {
  const auto second_view_x_m = [](const std::string& more) {
    const std::string text =
        small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"sensor\": \"kinect_v1\", " + more);
    return parse_rig(text, "rig").rig.cameras[0].margins->second_view_x_m;
  };
  EXPECT_EQ(second_view_x_m(""), 0.0) << "nobody says how the images were made";
  EXPECT_EQ(second_view_x_m("\"registered\": true, "), 0.0);
  EXPECT_EQ(second_view_x_m("\"registered\": false, "), 0.075);
  EXPECT_EQ(second_view_x_m(R"("registered": false, "margins": {"second_view_x_m": -0.06}, )"), -0.06);
  EXPECT_NE(test::thrown_message([&] {
              (void)second_view_x_m(R"("registered": true, "margins": {"second_view_x_m": 0.075}, )");
            }).find("/cameras/0/margins: second_view_x_m is 0.075 m and \"registered\" is true"),
            std::string::npos);
}

TEST(RigFile, AnOwnFarEndIsNotClampedBecauseTheSensorsIs) {
  const RigFile file = parse_rig(
      small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"sensor\": \"kinect_v1\", \"far_m\": 4,"), "rig");
  EXPECT_EQ(file.rig.cameras[0].rule.far_m, 4.0);
  EXPECT_FALSE(file.rig.cameras[0].rule.clamp_beyond_far);
}

TEST(RigFile, MarginsWithoutSensorStartFromZero) {
  const RigFile file = parse_rig(
      small_rig_with("\"id\": \"left\",", R"("id": "left", "margins": {"noise_quadratic_per_m": 0.003},)"), "rig");
  const CameraMargins& margins = *file.rig.cameras[0].margins;
  EXPECT_EQ(margins.sensor.quadratic_per_m, 0.003);
  EXPECT_EQ(margins.sensor.constant_m, 0.0);
  EXPECT_EQ(margins.sensor.lateral_px, 1);
  EXPECT_EQ(margins.half_exposure_s, 0.0);
  EXPECT_EQ(file.rig.cameras[0].rule.far_m, std::numeric_limits<double>::infinity());
}

TEST(RigFile, LeavesOutWhatMayBeLeftOut) {
  const RigFile file = parse_rig(
      R"({"cameras": [{"id": "a", "width": 4, "height": 3, "fx": 5, "fy": 5, "cx": 0e9, "cy": 1, "metres_per_unit": 1e-3,
          "T_world_cam": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})",
      "rig.json");
  EXPECT_EQ(file.frame_count, 1);
  EXPECT_EQ(file.first_frame, 0);
  EXPECT_FALSE(file.rate_hz.has_value());
  EXPECT_EQ(file.depth_files, std::vector<std::string>{""});
  EXPECT_EQ(file.rig.cameras[0].distortion.model, Distortion::Model::none);
  EXPECT_EQ(file.rig.cameras[0].intrinsics.cx_px, 0.5);
}

TEST(RigFile, KnownFreeTextPasses) {
  const std::string text = small_rig_with(
      "\"name\": \"small\",", R"("name": "small", "note": "a", "world_frame": "b", "suggested_rigs": [{"any": [1]}],)");
  EXPECT_NO_THROW(parse_rig(text, "rig.json"));
}

TEST(RigFile, LoadIsParseOfTheFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(load_rig(folder.write("rig.json", small_rig())).rig.cameras.size(), 2U);
}

TEST(RigFile, FrameNumbersAreFilledIn) {
  EXPECT_EQ(depth_file_name("a/%03d.png", 7), "a/007.png");
  EXPECT_EQ(depth_file_name("a/%03d.png", 12345), "a/12345.png");
  EXPECT_EQ(depth_file_name("%d_b.png", 42), "42_b.png");
  EXPECT_EQ(depth_file_name("still.png", 42), "still.png");
}

void expect_same(const CameraMargins& a, const CameraMargins& b) {
  EXPECT_EQ(a.sensor.constant_m, b.sensor.constant_m);
  EXPECT_EQ(a.sensor.linear, b.sensor.linear);
  EXPECT_EQ(a.sensor.quadratic_per_m, b.sensor.quadratic_per_m);
  EXPECT_EQ(a.sensor.lateral_px, b.sensor.lateral_px);
  EXPECT_EQ(a.translation_m, b.translation_m);
  EXPECT_EQ(a.rotation_rad, b.rotation_rad);
  EXPECT_EQ(a.half_exposure_s, b.half_exposure_s);
  EXPECT_EQ(a.time_uncertainty_s, b.time_uncertainty_s);
  EXPECT_EQ(a.second_view_x_m, b.second_view_x_m);
  EXPECT_EQ(std::isnan(a.smallest_obstacle_m), std::isnan(b.smallest_obstacle_m));
  EXPECT_TRUE(std::isnan(a.smallest_obstacle_m) || a.smallest_obstacle_m == b.smallest_obstacle_m);
}

void expect_same(const RigFile& a, const RigFile& b) {
  EXPECT_EQ(a.rig.name, b.rig.name);
  EXPECT_EQ(a.depth_files, b.depth_files);
  EXPECT_EQ(a.first_frame, b.first_frame);
  EXPECT_EQ(a.frame_count, b.frame_count);
  EXPECT_EQ(a.simultaneous, b.simultaneous);
  EXPECT_EQ(a.rate_hz, b.rate_hz);
  ASSERT_EQ(a.rig.T_floor_world.has_value(), b.rig.T_floor_world.has_value());
  if (a.rig.T_floor_world) {
    EXPECT_TRUE(a.rig.T_floor_world->isApprox(*b.rig.T_floor_world, 1e-12));
  }
  ASSERT_EQ(a.rig.cameras.size(), b.rig.cameras.size());
  for (std::size_t k = 0; k < a.rig.cameras.size(); ++k) {
    const RigCamera& x = a.rig.cameras[k];
    const RigCamera& y = b.rig.cameras[k];
    EXPECT_EQ(x.id, y.id);
    EXPECT_EQ(x.intrinsics.width_px, y.intrinsics.width_px);
    EXPECT_EQ(x.intrinsics.height_px, y.intrinsics.height_px);
    EXPECT_EQ(x.intrinsics.fx_px, y.intrinsics.fx_px);
    EXPECT_EQ(x.intrinsics.fy_px, y.intrinsics.fy_px);
    EXPECT_DOUBLE_EQ(x.intrinsics.cx_px, y.intrinsics.cx_px);
    EXPECT_DOUBLE_EQ(x.intrinsics.cy_px, y.intrinsics.cy_px);
    EXPECT_EQ(x.distortion.model, y.distortion.model);
    EXPECT_EQ(x.distortion.coefficients, y.distortion.coefficients);
    EXPECT_EQ(x.metres_per_unit, y.metres_per_unit);
    EXPECT_EQ(x.rule.near_m, y.rule.near_m);
    EXPECT_EQ(x.rule.far_m, y.rule.far_m);
    EXPECT_EQ(x.rule.clamp_beyond_far, y.rule.clamp_beyond_far);
    EXPECT_EQ(x.rule.invalid_units, y.rule.invalid_units);
    EXPECT_EQ(x.sensor, y.sensor);
    ASSERT_EQ(x.margins.has_value(), y.margins.has_value());
    if (x.margins) {
      expect_same(*x.margins, *y.margins);
    }
    EXPECT_TRUE(x.T_world_camera.isApprox(y.T_world_camera, 1e-12));
  }
}

RigFile random_rig(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  RigFile file;
  file.rig.name = "rig \"" + std::to_string(seed) + "\" \xC3\xA4";
  file.rig.T_floor_world = look_at({number(random), number(random), 5}, {0, 0, 0});
  file.first_frame = static_cast<int>(random() % 100);
  file.frame_count = 1 + static_cast<int>(random() % 100);
  file.simultaneous = random() % 2 == 0;
  if (random() % 2 == 0) {
    file.rate_hz = 30 + number(random);
  }
  for (std::size_t k = 0; k < 1 + random() % 4; ++k) {
    RigCamera camera;
    camera.id = "camera " + std::to_string(k);
    camera.intrinsics = {64, 48, 50 + number(random), 50 + number(random), 32 + number(random), 24 + number(random)};
    if (random() % 2 == 0) {
      camera.distortion = {Distortion::Model::rational, {number(random), number(random), 0, 0, 0, 0, 0, 1e-7}};
    }
    camera.metres_per_unit = 0.001 + 1e-4 * number(random);
    camera.rule = {0.25 + 0.1 * number(random), 5 + number(random), random() % 2 == 0, {0, 2047}};
    if (random() % 2 == 0) {  // whatever the sensor says of itself, the rig's own values are the ones that come back
      camera.rule = random() % 2 == 0 ? MeasurementRule{} : camera.rule;
      const auto part = [&] { return std::abs(number(random)); };
      camera.margins = CameraMargins{
          {part(), part(), part(), static_cast<int>(random() % 17)}, part(), 0.5 * part(), part(), part()};
      if (random() % 2 == 0) {
        camera.margins->smallest_obstacle_m = random() % 3 == 0 ? 0 : 0.5 * part();
        camera.margins->second_view_x_m = number(random);
      }
      const auto models = sensor_models();
      camera.sensor = random() % 2 == 0 ? models[random() % models.size()].name : std::string_view();
    }
    camera.T_world_camera = look_at({number(random), number(random), 2}, {number(random), 0, 0});
    file.rig.cameras.push_back(camera);
    file.depth_files.push_back("c" + std::to_string(k) + "/%05d.png");
  }
  return file;
}

TEST(RigFile, AByteOrderMarkAndWindowsLinesAreIgnored) {
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : small_rig()) {
    windows += c == '\n' ? "\r\n" : std::string(1, c);
  }
  expect_same(parse_rig(windows, "windows"), parse_rig(small_rig(), "unix"));
}

TEST(RigFile, DistortionModelsGoByTheNamesThatToolsGiveThem) {
  const auto model = [](const std::string& name, const std::string& coefficients) {
    return parse_rig(small_rig_with("\"plumb_bob\", \"coeffs\": [0, 0, 0, 0, 0]",
                                    "\"" + name + "\", \"coeffs\": " + coefficients),
                     "rig")
        .rig.cameras[1]
        .distortion;
  };
  const std::string eight = "[0.1, 0.02, 0.001, 0.002, 0.01, 0.1, 0.02, 0.01]";  // ROS's name, and ours
  EXPECT_EQ(model("rational_polynomial", eight).model, Distortion::Model::rational);
  EXPECT_EQ(model("rational_polynomial", eight).coefficients, model("rational", eight).coefficients);
  for (const char* name : {"equidistant", "fisheye", "kannala_brandt4"}) {
    const Distortion lens = model(name, "[0.01, -0.02, 0.003, -0.0004]");
    EXPECT_EQ(lens.model, Distortion::Model::equidistant);
    EXPECT_EQ(lens.coefficients, (std::array<double, 8>{0.01, -0.02, 0.003, -0.0004, 0, 0, 0, 0}));
  }
  EXPECT_EQ(model("radtan", "[0.1, 0.02, 0.001, 0.002]").model, Distortion::Model::plumb_bob);
  RigFile file = parse_rig(small_rig(), "rig");
  file.rig.cameras[0].distortion = make_distortion(Distortion::Model::equidistant, std::array{0.01, 0.0, 0.0, -0.001});
  expect_same(file, parse_rig(to_json(file), "written"));
}

TEST(RigFile, WritingAndLoadingGivesTheSameRig) {
  const test::RandomRun random_run = test::random_run(200);
  const auto first = static_cast<unsigned>(random_run.seed);
  const auto count = static_cast<unsigned>(random_run.count);
  for (unsigned seed = first; seed < first + count; ++seed) {
    const RigFile file = random_rig(seed);
    const std::string text = to_json(file);
    expect_same(file, parse_rig(text, "written"));
    ASSERT_FALSE(HasFailure()) << "DEPTHGRID_TEST_SEED=" << seed << " DEPTHGRID_TEST_COUNT=1\n" << text;
  }
}

TEST(RigFile, SavesWithoutLeavingAnythingBeside) {
  const TemporaryFolder folder;
  const RigFile file = parse_rig(small_rig(), "rig.json");
  save_rig(file, folder / "rig.json");
  save_rig(file, folder / "rig.json");
  EXPECT_EQ(folder.entries(), 1U);
  expect_same(file, load_rig(folder / "rig.json"));
}

TEST(RigFile, RefusesToWriteWhatItWouldNotLoad) {
  const TemporaryFolder folder;
  RigFile file = parse_rig(small_rig(), "rig.json");
  file.depth_files[0] = "../left_%03d.png";
  EXPECT_EQ(
      message_of([&] { save_rig(file, folder / "rig.json"); }),
      "rig 'small': /cameras/0/depth_files: '../left_%03d.png' has a part '..', must stay in the rig file's folder");
  file = parse_rig(small_rig(), "rig.json");
  file.rate_hz = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of([&] { save_rig(file, folder / "rig.json"); }),
            "rig 'small': holds NaN or infinity, which JSON cannot hold");
  file.rate_hz.reset();
  file.depth_files.pop_back();
  EXPECT_EQ(
      message_of([&] { save_rig(file, folder / "rig.json"); }),
      "rig 'small': 1 entries in depth_files for 2 cameras, needs one a camera (empty where there are no images)");
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(RigFile, SchemaInTheLibraryIsTheOneInTheDocuments) {
  EXPECT_EQ(rig_schema(), test::read_bytes("docs/rig.schema.json"));
}

/// The page shows a complete file; users copy it.
TEST(RigFile, ExampleOfTheDocumentsLoads) {
  const std::string page = test::read_bytes("docs/rig-file.md");
  const std::size_t begin = page.find("```json\n");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = page.find("```", begin + 8);
  const RigFile file = parse_rig(page.substr(begin + 8, end - begin - 8), "docs/rig-file.md");
  EXPECT_EQ(file.rig.cameras.size(), 2U);
  EXPECT_EQ(file.rig.cameras[0].margins->translation_m, 0.005);
  EXPECT_EQ(depth_file_name(file.depth_files[1], file.first_frame), "right/depth_0000.png");
}

}  // namespace
}  // namespace depthgrid::files
