#include "depthgrid/cell/cell_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "cell/cell_texts.hpp"
#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "files/temporary_folder.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::cell {
namespace {

using test::whole_cell;
using test::with;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string shown(const std::vector<ShownValue>& values, const std::string& key) {
  const auto found =
      std::find_if(values.begin(), values.end(), [&](const ShownValue& value) { return value.key == key; });
  return found == values.end() ? "none" : found->value + "|" + found->unit + "|" + found->origin;
}

TEST(CellFile, IsReadWithUnitsAndDefaults) {
  const Cell cell = parse_cell(whole_cell(), "/cells/a.yaml");
  EXPECT_EQ(cell.name, "test cell");
  ASSERT_EQ(cell.cameras.size(), 2U);
  EXPECT_EQ(cell.cameras[0].source, SourceKind::simulated);
  EXPECT_EQ(cell.cameras[0].rate_hz, 10);
  EXPECT_EQ(cell.cameras[1].rate_hz, 30);
  EXPECT_TRUE(cell.cameras[0].equal_images) << "ideal images of a scene that stands are equal";
  EXPECT_FALSE(cell.cameras[1].equal_images);
  EXPECT_EQ(cell.cameras[0].intrinsics->cx_px, 32.0) << "from OpenCV's convention";
  EXPECT_EQ(cell.cameras[0].smallest_obstacle_m, 0.02);
  // It looks along -x and a little down: the camera's z axis.
  EXPECT_LT(cell.cameras[0].T_world_camera->linear().col(2).x(), -0.9);
  // As the optical frame of ROS: z of the camera is the world's x.
  EXPECT_NEAR(cell.cameras[1].T_world_camera->linear().col(2).x(), 1, 1e-12);
  EXPECT_NEAR(*cell.cameras[1].margins.rotation_rad, 0.1 * std::numbers::pi / 180, 1e-15);
  EXPECT_NEAR(cell.robot->T_world_base.linear()(1, 0), 1, 1e-12) << "turned by 90 degrees about z";
  EXPECT_EQ(cell.policies.outside, views::Policy::ignored);
  EXPECT_EQ(cell.memory->voxel_m, 0.05);
  EXPECT_EQ(cell.memory->high_world, cell.space.high_world);
  EXPECT_EQ(cell.ask.points.at(0).radius_m, 0.1);
  EXPECT_EQ(cell.ages.image_s, 0.2);
  EXPECT_EQ(cell.ages.joints_s, 0.1);
  EXPECT_EQ(cell.outputs.udp->host, "127.0.0.1");
  EXPECT_EQ(cell.outputs.jsonl, "/cells/answers.jsonl") << "relative to the file";
}

TEST(CellFile, SaysOfEveryValueWhereItComesFrom) {
  const Cell cell = parse_cell(whole_cell(), "a.yaml");
  EXPECT_EQ(shown(cell.shown, "cameras[0].rate_hz"), "10|Hz|line 6");
  EXPECT_EQ(shown(cell.shown, "cameras[1].rate_hz"), "30|Hz|default");
  EXPECT_EQ(shown(cell.shown, "cameras[1].margins.rotation_deg"), "0.1|deg|line 15");
  EXPECT_EQ(shown(cell.shown, "ages.joints_s"), "0.1|s|default");
  EXPECT_EQ(shown(cell.shown, "space.low_m"), "-1, -1, 0|m|line 22");
  const CellSetup made = setup(cell);
  EXPECT_EQ(shown(made.shown, "cameras[1].margins.half_exposure_s").substr(0, 6), "0.0333");
  EXPECT_THAT(shown(made.shown, "cameras[1].margins.half_exposure_s"), HasSubstr("model kinect_v1"));
}

TEST(CellFile, BecomesARigSettingsAndQuestions) {
  const CellSetup made = setup(parse_cell(whole_cell(), "a.yaml"));
  ASSERT_EQ(made.rig.cameras.size(), 2U);
  EXPECT_EQ(made.rig.cameras[1].sensor, "kinect_v1");
  EXPECT_EQ(made.rig.cameras[1].rule.near_m, sensor_model("kinect_v1").rule.near_m);
  EXPECT_EQ(made.rig.cameras[1].margins->translation_m, 0.005);
  EXPECT_EQ(made.rig.cameras[0].margins->smallest_obstacle_m, 0.02);
  EXPECT_EQ(made.settings.rho_m, 0.6);
  EXPECT_EQ(made.options.max_image_age_s, 0.2);
  EXPECT_EQ(made.exposure.removal.padding_m, 0.05);
  EXPECT_EQ(made.parts.front().name, "lwr_7_link") << "the tool first";
  EXPECT_EQ(made.parts.back().name, "hand");
  EXPECT_FALSE(made.parts.back().on_robot);
  EXPECT_TRUE(made.parts.front().on_robot);
}

TEST(CellFile, IntrinsicsPoseAndMarginsComeFromARigFile) {
  test::TemporaryFolder folder;
  (void)folder.write("rig.json",
                     R"({"name": "r", "cameras": [{"id": "left", "width": 64, "height": 48, "fx": 55, "fy": 55,
    "cx": 31.5, "cy": 23.5, "metres_per_unit": 0.001, "sensor": "kinect_v1",
    "T_world_cam": [[1,0,0,0],[0,1,0,0],[0,0,1,-2],[0,0,0,1]]}]})");
  const std::string text = with(
      with(whole_cell(),
           "    intrinsics: {width_px: 64, height_px: 48, fx_px: 50, fy_px: 50, cx_px: 31.5, cy_px: 23.5}\n    pose: "
           "{position_m: [2, 0, 1], look_at_m: [0, 0, 0.5]}\n",
           "    rig: rig.json\n"),
      "    sensor: ideal\n", "");
  const CellSetup made = setup(parse_cell(text, folder / "cell.yaml"));
  EXPECT_EQ(made.rig.cameras[0].intrinsics.fx_px, 55);
  EXPECT_EQ(made.rig.cameras[0].T_world_camera.translation().z(), -2);
  EXPECT_EQ(made.rig.cameras[0].sensor, "kinect_v1");
  EXPECT_THAT(shown(made.shown, "cameras[0].intrinsics"), HasSubstr("rig.json"));
}

TEST(CellFile, TheExampleIsRight) {
  const Cell cell = parse_cell(example_cell(), "new.yaml");
  EXPECT_EQ(cell.cameras.size(), 2U);
  EXPECT_EQ(cell.cameras[0].source, SourceKind::ros2);
  EXPECT_TRUE(cell.outputs.ros2);
  EXPECT_EQ(cell.robot->joints.source, SourceKind::ros2);
}

TEST(CellFile, ImplausibleValuesAreTold) {
  const Cell cell =
      parse_cell(with(with(whole_cell(), "padding_m: 0.05", "padding_m: 0.001"), "rho_m: 0.6", "rho_m: 0.2"), "a.yaml");
  const std::vector<std::string> lines = implausible(cell, setup(cell));
  EXPECT_THAT(lines, ::testing::Contains(HasSubstr("padding_m: 0.001 m is less than what camera 'right' may err")));
  EXPECT_THAT(lines, ::testing::Contains(HasSubstr("rho_m: 0.2 m is less than what moves")));
  const Cell away = parse_cell(with(whole_cell(), "look_at_m: [0, 0, 0.5]", "look_at_m: [9, 0, 0.5]"), "a.yaml");
  EXPECT_THAT(implausible(away, setup(away)), ::testing::Contains(HasSubstr("is not in the camera's image")));
}

struct Broken {
  const char* what;
  const char* by;
  const char* place;    ///< LINE:COLUMN
  const char* message;  ///< a part of it: the value, the rule or the way out
};

// Each is one slip of somebody who edits the file; each gives one line that names place, value and way out.
constexpr Broken kBroken[] = {
    {"name: test cell", "nam: test cell", "1:1", "unknown key 'nam' (did you mean 'name'?)"},
    {"name: test cell\n", "", "1:1", "'name' is missing"},
    {"name: test cell", "name:", "1:1", "name: is empty: what this cell is called"},
    {"name: test cell", "name: [a, b]", "1:1", "name: must be one value"},
    {"name: test cell", "name: a\nname: b", "2:1", "name: stands here for the second time, first in line 1"},
    {"smallest_obstacle_m: 0.02\n", "", "3:5", "'smallest_obstacle_m' is missing"},
    {"smallest_obstacle_m: 0.02", "smallest_obstacle_m: 20 mm", "2:1", "'20 mm' must be a finite number"},
    {"smallest_obstacle_m: 0.02", "smallest_obstacle: 0.02", "2:1", "did you mean 'smallest_obstacle_m'?"},
    {"smallest_obstacle_m: 0.02", "smallest_obstacle_mm: 20", "2:1", "did you mean 'smallest_obstacle_m'?"},
    {"smallest_obstacle_m: 0.02", "smallest_obstacle_m: -1", "2:1", "-1 m must be at least 0 and at most 1"},
    {"cameras:", "camera:", "3:1", "did you mean 'cameras'?"},
    {"  - name: right", "  - name: left", "10:5", "a camera is called 'left' for the second time"},
    {"source: simulated", "source: simulate", "5:5", "'simulate' is not known (did you mean 'simulated'?)"},
    {"source: simulated", "source: webcam", "5:5", "'webcam' is not known (known: recording, simulated, realsense"},
    {"    source: simulated\n", "", "4:5", "'source' is missing: where the images come from"},
    {"rate_hz: 10", "rate_hz: 0", "6:5", "0 Hz must be above 0 and at most 1000"},
    {"rate_hz: 10", "rate_hz: nan", "6:5", "'nan' must be a finite number"},
    {"rate_hz: 10", "serial: 7", "6:5", "says nothing with source: simulated, remove it"},
    {"width_px: 64", "width_px: 64.5", "7:18", "64.5 must be a whole number"},
    {"height_px: 48, ", "", "7:17", "'height_px' is missing: as OpenCV and ROS state them"},
    {"fx_px: 50, fy_px: 50, cx_px: 31.5", "fx_px: -50, fy_px: 50, cx_px: 31.5", "7:47", "-50 px must be above 0"},
    {"position_m: [2, 0, 1]", "position_m: [2, 0]", "8:12", "has 2 numbers, must have 3"},
    {"position_m: [2, 0, 1]", "position_m: 2", "8:12", "must be a list of 3 numbers in [ ]"},
    {"position_m: [2, 0, 1]", "position_m: [2, 0, 1e9]", "8:12", "1e+09 must be within +-1"},
    {", look_at_m: [0, 0, 0.5]", "", "8:11", "states 0 of look_at_m, rpy_deg and quaternion_xyzw, must state one"},
    {"look_at_m: [0, 0, 0.5]", "look_at_m: [2, 0, 1]", "8:35", "look_at_m"},
    {"look_at_m: [0, 0, 0.5]", "quaternion_xyzw: [0, 0, 0, 0.5]", "8:35", "has length 0.5, must be 1"},
    {"look_at_m: [0, 0, 0.5]", "rpy_deg: [0, 0, 0], up: [0, 0, 1]", "8:55", "belongs to look_at_m"},
    {"sensor: kinect_v1", "sensor: kinect", "14:5", "kinect"},
    {"    pose: {position_m: [2, 0, 1], look_at_m: [0, 0, 0.5]}\n", "", "4:5", "'pose' is missing"},
    {"position_m: [2, 0, 1], look_at_m: [0, 0, 0.5]", "frame: camera", "8:12", "is looked up on /tf, which only"},
    {"position_m: [2, 0, 1],", "position_m: [2, 0, 1], max_age_s: 1,", "8:35", "belongs to frame, remove it"},
    {"source: simulated\n    rate_hz: 10", "source: recording\n    recording: a\n    rig: rig.json", "7:5",
     "rig: says nothing with source: recording, which has a rig file or camera_info of its own"},
    {"rotation_deg: 0.1", "rotation_rad: 0.1", "15:37", "unknown key 'rotation_rad' (did you mean 'rotation_deg'?)"},
    {"margins: {translation_m: 0.005, rotation_deg: 0.1}", "margins: 0.005", "15:5",
     "must be a map of keys and values"},
    {"  urdf: kuka_lwr4\n", "", "17:3", "'urdf' is missing: the robot's file"},
    {"time_error_s: 0.002", "time_error_s: 2 ms", "19:31", "'2 ms' must be a finite number"},
    {", time_error_s: 0.002", "", "19:11", "'time_error_s' is missing: by how much an image's time may differ"},
    {"joints: {source: simulated", "joints: {source: recording", "19:11", "'file' is missing"},
    {"padding_m: 0.05", "padding_m: 5", "20:3", "5 m must be at least 0 and at most 1"},
    {"  base: {position_m: [0, 0, 0], rpy_deg: [0, 0, 90]}\n", "", "17:3",
     "'base' is missing: where the robot's root link"},
    {"high_m: [1, 1, 1.5]", "high_m: [1, -1, 1.5]", "22:29", "must be above low_m in x, y and z"},
    {"unobserved: obstacle", "unobserved: maybe", "23:12", "'maybe' is not known (known: obstacle, ignored)"},
    {"unobserved: obstacle, ", "", "23:11", "'unobserved' is missing: space that no camera looks at"},
    {"robot_pockets: obstacle", "robot_pockets: ignored", "23:11", "'ignored_pocket_m' is missing: how deep"},
    {"robot_pockets: obstacle", "robot_pockets: obstacle, ignored_pocket_m: 0.1", "23:77",
     "says nothing with robot_pockets: obstacle"},
    {"v_max_m_s: 1.6\n", "", "1:1", "'v_max_m_s' is missing: nothing in the cell moves faster"},
    {"v_max_m_s: 1.6", "v_max: 1.6", "24:1", "did you mean 'v_max_m_s'?"},
    {"memory: {start: unknown, voxel_m: 0.05}\n", "", "1:1", "'memory' is missing: memory: none, or {start: unknown}"},
    {"memory: {start: unknown, voxel_m: 0.05}", "memory: some", "25:1", "'some' is not known (did you mean 'none'?)"},
    {"start: unknown, ", "", "25:9", "'start' is missing"},
    {"  links: moving\n", "  links: movin\n", "28:3", "did you mean 'moving'?"},
    {"  links: moving\n  points: [{name: hand, at_m: [0.5, 0, 0.8], radius_m: 0.1}]\n", "", "27:3", "nothing is asked"},
    {"at_m: [0.5, 0, 0.8]", "at: [0.5, 0, 0.8]", "29:25", "did you mean 'at_m'?"},
    {"image_s: 0.2", "image_ms: 200", "31:8", "did you mean 'image_s'?"},
    {"port: 47000", "port: 470000", "33:9", "must be at least 1 and at most 65535"},
    {"port: 47000", "prot: 47000", "33:9", "did you mean 'port'?"},
    {"  jsonl: answers.jsonl", "  jsonl:", "34:3", "is empty"},
};

TEST(CellFile, ASlipIsOneLineWithPlaceValueAndWayOut) {
  ASSERT_GE(std::size(kBroken), 40U);
  for (const Broken& broken : kBroken) {
    const std::string text = with(whole_cell(), broken.what, broken.by);
    const std::string message = test::thrown_message([&] { (void)parse_cell(text, "cell.yaml"); });
    EXPECT_THAT(message, StartsWith("cell.yaml:" + std::string(broken.place) + ": ")) << broken.by;
    EXPECT_THAT(message, HasSubstr(broken.message)) << broken.by;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(CellFile, TextsThatAreNoCellAreRefused) {
  for (const char* text :
       {"", "just words", "- a\n- list\n", "a: [", "cameras: &x [*x]", "name: \"\\x01\"", "\t", "---\n"}) {
    const std::string message = test::thrown_message([&] { (void)parse_cell(text, "cell.yaml"); });
    EXPECT_THAT(message, StartsWith("cell.yaml:")) << text;
  }
}

TEST(CellFile, KeysThatDoNotPrintAreWrittenOut) {
  using namespace std::string_view_literals;
  EXPECT_THAT(test::thrown_message([] { (void)parse_cell(":9N\0nmoving: "sv, "cell.yaml"); }),
              StartsWith(R"(cell.yaml:1:1: unknown key ':9N\nmoving')"));
  EXPECT_THAT(test::thrown_message([] { (void)parse_cell("\"a\\nb\": 1", "cell.yaml"); }),
              StartsWith(R"(cell.yaml:1:1: unknown key 'a\nb')"));
}

TEST(CellFile, WhatOtherFilesLackIsTold) {
  const auto of = [](const std::string& what, const std::string& by) {
    return test::thrown_message([&] { (void)setup(parse_cell(with(whole_cell(), what, by), "cell.yaml")); });
  };
  EXPECT_THAT(of("urdf: kuka_lwr4", "urdf: none.urdf"), HasSubstr("none.urdf"));
  EXPECT_THAT(of("tool: lwr_7_link", "tool: gripper"), HasSubstr("gripper"));
  EXPECT_THAT(of("    sensor: ideal\n", ""),
              HasSubstr("cameras[0]: says nothing about how far the camera's readings may err"));
  EXPECT_THAT(of("    source: simulated\n    rate_hz: 10", "    source: recording\n    recording: nowhere"),
              HasSubstr("nowhere"));
  EXPECT_THAT(of("links: moving", "links: [no_such_link]"), HasSubstr("no_such_link"));
  // A link that has no shape cannot be asked, and is not passed over.
  test::TemporaryFolder folder;
  (void)folder.write("arm.urdf", R"(<robot name="arm"><link name="base"/>
    <link name="arm"><collision><geometry><box size="0.1 0.1 0.5"/></geometry></collision></link><link name="tip"/>
    <joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
    <joint name="f" type="fixed"><parent link="arm"/><child link="tip"/></joint></robot>)");
  const std::string arm = with(with(whole_cell(), "urdf: kuka_lwr4", "urdf: arm.urdf"), "  tool: lwr_7_link\n", "");
  const auto asks = [&](const std::string& links) {
    return test::thrown_message(
        [&] { (void)setup(parse_cell(with(arm, "links: moving", "links: " + links), folder / "cell.yaml")); });
  };
  EXPECT_EQ(asks("[arm]"), "");
  EXPECT_THAT(asks("[arm, tip]"), HasSubstr("ask: links: tip has no shape in the robot's file"));
}

TEST(CellFile, ATopicsCameraMayStandWhereItsFrameIs) {
  std::string text = whole_cell();
  const auto replace = [&](const std::string& what, const std::string& by) {
    ASSERT_NE(text.find(what), std::string::npos) << what;
    text.replace(text.find(what), what.size(), by);
  };
  replace("    pose: {position_m: [2, 0, 1], look_at_m: [0, 0, 0.5]}\n",
          "    pose: {frame: left_optical, max_age_s: 0.2, image_frame: left}\n");
  replace("source: simulated\n    rate_hz: 10\n", "source: ros2\n    topic: /left/image_rect\n");
  const Cell cell = parse_cell(text, "a.yaml");
  EXPECT_EQ(cell.cameras[0].frame, "left_optical");
  EXPECT_EQ(cell.cameras[0].frame_age_s, 0.2);
  EXPECT_EQ(cell.cameras[0].image_frame, "left");
  EXPECT_FALSE(cell.cameras[0].T_world_camera);
  EXPECT_TRUE(setup(cell).rig.cameras[0].T_world_camera.isApprox(Pose::Identity())) << "until its images come";
  EXPECT_THAT(test::thrown_message([&] {
                (void)parse_cell(with(text, "frame: left_optical,", "frame: a, position_m: [0, 0, 1],"), "a.yaml");
              }),
              HasSubstr("says nothing beside frame"));
}

TEST(CellFile, ACameraThatMovesIsUncertainByItsMotionWithinTheExposure) {
  const std::string text =
      with(with(with(whole_cell(), "source: simulated\n    intrinsics", "source: ros2\n    topic: /a\n    intrinsics"),
                "pose: {position_m: [-2, 0, 1], rpy_deg: [-90, 0, -90]}", "pose: {frame: hand}"),
           "rotation_deg: 0.1}", "rotation_deg: 0.1, half_exposure_s: 0.01, time_uncertainty_s: 0.02}");
  EXPECT_THAT(
      test::thrown_message([&] { (void)setup(parse_cell(text, "a.yaml")); }),
      HasSubstr("images are sure to 0.03 s (margins: half_exposure_s, time_uncertainty_s), and nothing says how "
                "far the camera moves in that time"));
  const CellSetup made =
      setup(parse_cell(with(text, "{frame: hand}", "{frame: hand, max_speed_m_s: 0.5, max_turn_deg_s: 60}"), "a.yaml"));
  EXPECT_NEAR(made.settings.margins[1].translation_m, 0.005 + 0.5 * 0.03, 1e-12);
  EXPECT_NEAR(made.settings.margins[1].rotation_rad, (0.1 + 60 * 0.03) * std::numbers::pi / 180, 1e-12);
}

TEST(CellFile, CamerasThatWereFoundStandWhereNobodyKnows) {
  const std::vector<ExampleCamera> found{{.name = "camera1",
                                          .source = "freenect",
                                          .serial = "7",
                                          .intrinsics = PinholeCamera{640, 480, 594, 591, 320, 240}}};
  std::string text = example_cell(found);
  EXPECT_THAT(test::thrown_message([&] { (void)parse_cell(text, "new.yaml"); }),
              HasSubstr("cameras[0].pose.position_m: 'measure' must be a finite number"));
  text = with(text, "[measure, measure, measure]", "[1.8, 0, 1.4]");
  EXPECT_NE(test::thrown_message([&] { (void)parse_cell(text, "new.yaml"); }), "") << "look_at_m";
  text = with(text, "[measure, measure, measure]", "[0, 0, 0.5]");
  EXPECT_THAT(test::thrown_message([&] { (void)parse_cell(text, "new.yaml"); }), HasSubstr("margins.translation_m"));
  text =
      with(with(text, "translation_m: measure", "translation_m: 0.01"), "rotation_deg: measure", "rotation_deg: 0.2");
  EXPECT_FALSE(parse_cell(text, "new.yaml").cameras[0].intrinsics) << "usual ones are not this camera's";
}

}  // namespace
}  // namespace depthgrid::cell
