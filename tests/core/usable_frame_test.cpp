// One rule says which frames can be used: everything that takes frames goes by it.
#include "depthgrid/core/usable_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/views/view.hpp"

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

/// Everything that takes frames or images.
struct Consumers {
  Rig rig = one_camera();
  views::View view{rig.cameras[0], {}, {}};
  grid::GridEvaluator evaluator{rig, 0, {0.3, 0.1, 0.0, 20}, {}};
  // One ball before the other: the reading says which one the ray's interval is.
  robot::RobotRemoval removal{
      rig.cameras[0].intrinsics, {{0, {{0, 0, 1}, {0, 0, 1}, 0.1}}, {0, {{0, 0, 2}, {0, 0, 2}, 0.1}}}, {}};

  void expect(bool usable, bool usable_image, const Frame& frame, const char* what) {
    EXPECT_EQ(why_unusable(frame, rig.cameras[0]) == nullptr, usable) << what;
    EXPECT_EQ(view.why_unusable(frame) == nullptr, usable) << what;
    EXPECT_EQ(view.update(frame, Pose::Identity()), usable) << what;
    EXPECT_EQ(evaluator.update(0, frame).taken(), usable) << what;
    const Pose T_world_link = Pose::Identity();
    const RobotView seen = removal.find({&T_world_link, 1}, Pose::Identity(), {}, &frame.depth);
    EXPECT_EQ(seen.near_m[seen.stride_px * (kHeight / 2) + kWidth / 2] > 1.5F, usable_image) << what;
  }
};

TEST(UsableFrame, IsTheSameToAll) {
  const Wall wall;
  Consumers all;
  struct Change {
    const char* what;
    std::function<void(Frame&)> change;
    bool usable_image = false;
  };
  const std::vector<Change> changes{
      {"no data", [](Frame& f) { f.depth.data = nullptr; }},
      {"another width", [](Frame& f) { f.depth.width_px = kWidth - 1; }},
      {"another height", [](Frame& f) { f.depth.height_px = kHeight + 1; }},
      {"rows that overlap", [](Frame& f) { f.depth.stride_bytes = 2 * kWidth - 2; }},
      {"rows between two values", [](Frame& f) { f.depth.stride_bytes = 2 * kWidth + 1; }},
      {"values that are not aligned",
       [](Frame& f) { f.depth.data = static_cast<const std::byte*>(static_cast<const void*>(f.depth.data)) + 1; }},
      {"rows that overlap upwards", [](Frame& f) { f.depth.stride_bytes = 2 - 2 * kWidth; }},
      {"another scale", [](Frame& f) { f.depth.metres_per_unit = 0.00101; }, true},
      {"only near ends", [](Frame& f) { f.robot.far_m = nullptr; }, true},
      {"only far ends", [](Frame& f) { f.robot.near_m = nullptr; }, true},
      {"robot rows that overlap", [](Frame& f) { f.robot.stride_px = kWidth - 1; }, true},
      {"robot rows that overlap upwards", [](Frame& f) { f.robot.stride_px = 1 - kWidth; }, true},
  };
  for (const Change& bad : changes) {
    Frame frame = wall.frame();
    all.expect(true, true, frame, "good");
    bad.change(frame);
    all.expect(false, bad.usable_image, frame, bad.what);
  }
}

TEST(UsableFrame, RowsMayGoUpwards) {
  const Wall wall;
  Consumers all;
  Frame frame = wall.frame();
  frame.depth.data = wall.units.data() + kPixels - kWidth;
  frame.depth.stride_bytes = -2 * kWidth;
  all.expect(true, true, frame, "depth upwards");
  frame = wall.frame();
  frame.robot = {wall.near_m.data() + kPixels - kWidth, wall.far_m.data() + kPixels - kWidth, -kWidth};
  all.expect(true, true, frame, "robot upwards");
}

TEST(UsableFrame, AStrideOfZeroIsThatOfRowsWithoutPadding) {
  Wall wall;
  // The first row shows other things than the rest.
  std::fill_n(wall.units.begin(), kWidth, std::uint16_t{1000});
  Consumers all;
  Frame frame = wall.frame();
  frame.depth.stride_bytes = 0;
  frame.robot.stride_px = 0;
  all.expect(true, true, frame, "dense");
  EXPECT_NEAR(all.view.measured_m(1, 0), 1.0, 1e-6);
  EXPECT_NEAR(all.view.measured_m(1, 1), 2.0, 1e-6);
  EXPECT_EQ(with_strides(frame).depth.stride_bytes, 2 * kWidth);
  EXPECT_EQ(with_strides(frame).robot.stride_px, kWidth);
}

}  // namespace
}  // namespace depthgrid
