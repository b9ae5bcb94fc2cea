// One rule says which frames can be used: everything that takes frames goes by it.
#include "depthgrid/core/usable_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid {
namespace {

constexpr int kWidth = 24;
constexpr int kHeight = 18;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

Rig one_camera() {
  Rig rig{.name = "cell", .cameras = std::vector<RigCamera>(1), .T_floor_world = {}};
  rig.cameras[0].id = "front";
  rig.cameras[0].intrinsics = {kWidth, kHeight, 20, 20, 12, 9};
  return rig;
}

/// A wall at 2 m.
struct Wall {
  std::vector<std::uint16_t> units = std::vector<std::uint16_t>(kPixels, 2000);
  std::vector<float> near_m = std::vector<float>(kPixels, 0.0F);
  std::vector<float> far_m = std::vector<float>(kPixels, 0.0F);
  [[nodiscard]] Frame frame() const {
    return {depth_view(units, kWidth, kHeight, 0.001), {near_m.data(), far_m.data(), kWidth}, 1.0};
  }
};

grid::EvaluationSettings settings_of(grid::Variant variant, grid::RobotPixels robot_pixels) {
  grid::EvaluationSettings settings;
  settings.variant = variant;
  settings.robot_pixels = robot_pixels;
  settings.sensor.lateral_px = 0;
  return settings;
}

/// Which of those that take frames can use one. All others want the frame as it is.
struct Usable {
  bool frame = false;
  bool image = false;   ///< by its size and rows alone: the removal knows no scale and makes the robot view itself
  bool intake = false;  ///< the intake knows the scale, and makes the robot view itself
};

/// Everything that takes frames or images.
struct Consumers {
  using Variant = grid::Variant;
  using RobotPixels = grid::RobotPixels;

  Rig rig = one_camera();
  views::View view{rig.cameras[0], {}, {}};
  views::ViewStore store{rig, store_settings()};
  grid::GridEvaluator letter{rig, 0, {0.3, 0.1, 0.0, 20}, settings_of(Variant::letter, RobotPixels::case_iv)};
  grid::GridEvaluator corrected{rig, 0, {0.3, 0.1, 0.0, 20}, settings_of(Variant::corrected, RobotPixels::case_iv)};
  grid::GridEvaluator letter_removed{rig, 0, {0.3, 0.1, 0.0, 20}, settings_of(Variant::letter, RobotPixels::removed)};
  grid::GridEvaluator corrected_removed{
      rig, 0, {0.3, 0.1, 0.0, 20}, settings_of(Variant::corrected, RobotPixels::removed)};
  // One ball before the other: the reading says which one the ray's interval is.
  robot::RobotRemoval removal{
      rig.cameras[0].intrinsics, {{0, {{0, 0, 1}, {0, 0, 1}, 0.1}}, {0, {{0, 0, 2}, {0, 0, 2}, 0.1}}}, {}};
  robot::PlacedRobot arm{robot::kuka_lwr4()};
  robot::JointHistory history{7, 16, 0.02, 0.01};
  robot::FrameIntake intake = intake_of_arm();

  static views::Settings store_settings() {
    views::Settings settings;
    settings.space = views::BoxSpace{{-1, -1, 0.5}, {1, 1, 3}};
    settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
    settings.margins.resize(1);
    settings.margins[0].smallest_obstacle_m = 0;
    settings.v_max_m_s = 0;
    return settings;
  }
  robot::FrameIntake intake_of_arm() {
    arm.T_world_base.translation().z() = 2;
    for (const double time_s : {0.99, 1.0, 1.01}) {
      EXPECT_TRUE(history.add(time_s, std::vector<double>(7, 0.0)));
    }
    return {rig, arm, history, {}};
  }

  void expect(const Usable& usable, const Frame& frame, const char* what) {
    SCOPED_TRACE(what);
    const char* const reason = why_unusable(frame, rig.cameras[0]);
    EXPECT_EQ(reason == nullptr, usable.frame);
    EXPECT_STREQ(view.why_unusable(frame), reason);
    EXPECT_EQ(view.update(frame, Pose::Identity()), usable.frame);
    EXPECT_EQ(view.free_m(kWidth / 2, kHeight / 2) > 1, usable.frame);
    expect_update(store.update(0, frame), usable.frame, reason);
    EXPECT_EQ(store.snapshot().view(0).present(), usable.frame);
    for (grid::GridEvaluator* const evaluator : {&letter, &corrected, &letter_removed, &corrected_removed}) {
      expect_update(evaluator->update(0, frame), usable.frame, reason);
      // A metre before the wall; where nothing was seen it may touch something.
      const double distance_m = evaluator->distance(Capsule::point({0, 0, 1})).distance_now_m;
      EXPECT_TRUE(usable.frame ? distance_m > 0.3 : distance_m == 0) << distance_m;
    }
    const Pose T_world_link = Pose::Identity();
    const RobotView seen = removal.find({&T_world_link, 1}, Pose::Identity(), {}, &frame.depth);
    EXPECT_EQ(seen.near_m[seen.stride_px * (kHeight / 2) + kWidth / 2] > 1.5F, usable.image);
    const Frame with_arm = intake.frame(0, frame);
    EXPECT_EQ(intake.report()[0].robot_removed, usable.intake);
    EXPECT_EQ(intake.report()[0].blind_m > 0, usable.intake);
    EXPECT_EQ(why_unusable(with_arm, rig.cameras[0]) == nullptr, usable.intake);
  }
  static void expect_update(const FrameUpdate& update, bool usable, const char* reason) {
    EXPECT_EQ(update.result, usable ? UpdateResult::taken : UpdateResult::unusable);
    EXPECT_STREQ(update.reason, usable ? "" : reason);
  }
};

constexpr Usable kAll{true, true, true};

TEST(UsableFrame, IsTheSameToAll) {
  const Wall wall;
  Consumers all;
  struct Change {
    const char* what;
    std::function<void(Frame&)> change;
    Usable usable;
  };
  constexpr Usable kScale{false, true, false};
  constexpr Usable kRobot{false, true, true};
  const std::vector<Change> changes{
      {"no data", [](Frame& f) { f.depth.data = nullptr; }, {}},
      {"another width", [](Frame& f) { f.depth.width_px = kWidth - 1; }, {}},
      {"another height", [](Frame& f) { f.depth.height_px = kHeight + 1; }, {}},
      {"rows that overlap", [](Frame& f) { f.depth.stride_bytes = 2 * kWidth - 2; }, {}},
      {"rows between two values", [](Frame& f) { f.depth.stride_bytes = 2 * kWidth + 1; }, {}},
      {"values that are not aligned",
       [](Frame& f) { f.depth.data = static_cast<const std::byte*>(static_cast<const void*>(f.depth.data)) + 1; },
       {}},
      {"rows that overlap upwards", [](Frame& f) { f.depth.stride_bytes = 2 - 2 * kWidth; }, {}},
      {"another scale", [](Frame& f) { f.depth.metres_per_unit = 0.00101; }, kScale},
      {"only near ends", [](Frame& f) { f.robot.far_m = nullptr; }, kRobot},
      {"only far ends", [](Frame& f) { f.robot.near_m = nullptr; }, kRobot},
      {"robot rows that overlap", [](Frame& f) { f.robot.stride_px = kWidth - 1; }, kRobot},
      {"robot rows that overlap upwards", [](Frame& f) { f.robot.stride_px = 1 - kWidth; }, kRobot},
      {"a layer of no thickness", [](Frame& f) { f.robot.blind_m = -0.001; }, kRobot},
      {"a reach without end", [](Frame& f) { f.robot.reach_m = std::numeric_limits<double>::infinity(); }, kRobot},
  };
  for (const Change& bad : changes) {
    Frame frame = wall.frame();
    all.expect(kAll, frame, "good");
    bad.change(frame);
    all.expect(bad.usable, frame, bad.what);
  }
}

TEST(UsableFrame, RowsMayGoUpwards) {
  const Wall wall;
  Consumers all;
  Frame frame = wall.frame();
  frame.depth.data = wall.units.data() + kPixels - kWidth;
  frame.depth.stride_bytes = -2 * kWidth;
  all.expect(kAll, frame, "depth upwards");
  frame = wall.frame();
  frame.robot = {wall.near_m.data() + kPixels - kWidth, wall.far_m.data() + kPixels - kWidth, -kWidth};
  all.expect(kAll, frame, "robot upwards");
}

TEST(UsableFrame, AStrideOfZeroIsThatOfRowsWithoutPadding) {
  Wall wall;
  // The first row shows other things than the rest.
  std::fill_n(wall.units.begin(), kWidth, std::uint16_t{1000});
  Consumers all;
  Frame frame = wall.frame();
  frame.depth.stride_bytes = 0;
  frame.robot.stride_px = 0;
  all.expect(kAll, frame, "dense");
  EXPECT_NEAR(all.view.measured_m(1, 0), 1.0, 1e-6);
  EXPECT_NEAR(all.view.measured_m(1, 1), 2.0, 1e-6);
  EXPECT_EQ(with_strides(frame).depth.stride_bytes, 2 * kWidth);
  EXPECT_EQ(with_strides(frame).robot.stride_px, kWidth);
}

}  // namespace
}  // namespace depthgrid
