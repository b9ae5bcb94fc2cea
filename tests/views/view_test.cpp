// A prepared image against its definition, on every instruction set of this machine.
#include "depthgrid/views/view.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <cstring>

#include "depthgrid/views/prepared_image.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "views/random_frame.hpp"
#include "views/view_twin.hpp"

namespace depthgrid::views {
namespace {

/// Calls `body` once for every instruction set that was compiled and that this machine has.
template <class Body>
void for_every_target(const Body& body) {
  int count = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    ++count;
    SCOPED_TRACE(hwy::TargetName(target));
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(count, 1);
}

/// Everything that a view holds, as one string of bits.
std::vector<std::uint32_t> bits(const View& view) {
  const PreparedImage& image = prepared(view);
  std::vector<std::uint32_t> result{view.present() ? 1U : 0U, image.has_islands ? 1U : 0U};
  const auto append = [&result](const float* values, std::size_t count) {
    const std::size_t old = result.size();
    result.resize(old + count);
    std::memcpy(result.data() + old, values, count * sizeof(float));
  };
  const std::size_t pixels = image.free_m.index(0, view.height_px());
  const std::size_t texels = image.minima_m.size();
  for (int v = 0; v < view.height_px(); ++v) {
    for (int u = 0; u < view.width_px(); ++u) {
      const float measured_m = view.measured_m(u, v);
      append(&measured_m, 1);
    }
  }
  append(image.free_m.data(), pixels);
  append(image.minima_m.data(), texels);
  if (image.has_islands) {
    append(image.island_near_m.data(), pixels);
    append(image.island_far_m.data(), pixels);
    append(image.second_near_maxima_m.data(), texels);
    append(image.second_far_minima_m.data(), texels);
  }
  return result;
}

/// Sizes around the lengths of vectors, and others.
std::array<int, 2> random_size(std::int64_t n, std::mt19937_64& random) {
  constexpr std::array<std::array<int, 2>, 12> kSizes{
      {{1, 1}, {7, 5}, {97, 33}, {1, 40}, {40, 1}, {2, 2}, {16, 16}, {17, 9}, {32, 3}, {33, 64}, {64, 48}, {80, 65}}};
  if (static_cast<std::size_t>(n) < kSizes.size()) {
    return kSizes[static_cast<std::size_t>(n)];
  }
  const auto side = [&random] { return std::uniform_int_distribution<int>(1, 70)(random); };
  return {side(), side()};
}

TEST(View, FollowsItsDefinitionOnEveryInstructionSet) {
  const test::RandomRun run = test::random_run(300);
  std::mt19937_64 random(run.seed);
  int islands = 0;
  int joined = 0;
  for (std::int64_t n = 0; n < run.count && !HasFailure(); ++n) {
    const auto [width_px, height_px] = random_size(n, random);
    const RandomCamera c = random_camera(width_px, height_px, random);
    const std::array<RandomFrame, 3> frames{RandomFrame(c, random), RandomFrame(c, random), RandomFrame(c, random)};
    SCOPED_TRACE("camera " + std::to_string(n) + " of " + run.reproduce() + ", " + std::to_string(width_px) + " x " +
                 std::to_string(height_px));
    std::vector<std::vector<std::uint32_t>> first;
    for_every_target([&] {
      View view(c.camera, c.margins, c.policies);
      // One after the other, so that what an earlier frame left behind would show.
      for (std::size_t f = 0; f < frames.size(); ++f) {
        SCOPED_TRACE("frame " + std::to_string(f));
        ASSERT_TRUE(view.update(frames[f].frame(), Pose::Identity()));
        EXPECT_EQ(view.time_s(), frames[f].frame().time_s);
        islands += prepared(view).has_islands ? 1 : 0;
        joined += frames[f].frame().robot.near_m != nullptr ? 1 : 0;
        if (first.size() == f) {
          ASSERT_TRUE(follows_definition(view, c.camera, c.margins, c.policies, frames[f].frame()));
          first.push_back(bits(view));
        }
        ASSERT_TRUE(first[f] == bits(view)) << "other bits than the first instruction set";
      }
    });
  }
  EXPECT_TRUE((islands > 10 && joined > 10) || run.count < 100);
}

/// One camera of 5 x 4 pixels in millimetres, without margins or filter unless they are set.
struct SmallCamera {
  RigCamera camera;
  CameraMargins margins;
  Policies policies{Policy::obstacle, Policy::obstacle, Policy::obstacle, 0};
  std::vector<std::uint16_t> units = std::vector<std::uint16_t>(20, 2000);
  std::vector<float> near_m = std::vector<float>(20, 0.0F);
  std::vector<float> far_m = std::vector<float>(20, 0.0F);

  SmallCamera() {
    camera.id = "small";
    camera.intrinsics = {5, 4, 10, 10, 2.5, 2};
    margins.sensor.lateral_px = 0;
  }
  [[nodiscard]] Frame frame() const { return {depth_view(units, 5, 4, 0.001), {near_m.data(), far_m.data(), 5}, 1.0}; }
  [[nodiscard]] View view() const {
    View result(camera, margins, policies);
    EXPECT_TRUE(result.update(frame(), Pose::Identity()));
    return result;
  }
};

TEST(View, RobotByHand) {
  SmallCamera c;
  // A reading in the robot's interval; one before the robot; none; one behind the robot.
  c.units = std::vector<std::uint16_t>(20, 2000);
  c.units[1] = 1000;
  c.units[2] = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    c.near_m[i] = 1.5F;
    c.far_m[i] = 2.5F;
  }
  c.near_m[3] = 1.0F;
  c.far_m[3] = 1.5F;
  const View view = c.view();
  EXPECT_EQ(view.free_m(0, 0), 2.5F) << "up to the robot's exit";
  EXPECT_NEAR(view.free_m(1, 0), 1.0, 2e-6) << "a hand before the robot stays";
  EXPECT_EQ(view.free_m(2, 0), 0.0F) << "the robot's mask alone frees nothing";
  EXPECT_NEAR(view.free_m(3, 0), 2.0, 2e-6) << "seen past the robot";
  EXPECT_NEAR(view.free_m(4, 0), 2.0, 2e-6) << "no robot";
  ASSERT_TRUE(prepared(view).has_islands);
  for (int u = 0; u < 5; ++u) {
    const bool island = u == 1 || u == 2;
    EXPECT_EQ(prepared(view).island_near_m.at(u, 0), island ? 1.5F : std::numeric_limits<float>::infinity()) << u;
    EXPECT_EQ(prepared(view).island_far_m.at(u, 0), island ? 2.5F : -std::numeric_limits<float>::infinity()) << u;
  }
}

TEST(View, JoinsTheRobotOfAPixelThatTheFilterLowered) {
  SmallCamera c;
  c.margins.sensor.lateral_px = 1;
  c.near_m[6] = 1.5F;  // pixel (1, 1), whose neighbours see the wall behind at 2 m
  c.far_m[6] = 2.5F;
  const View view = c.view();
  EXPECT_EQ(view.free_m(1, 1), 2.5F);
  EXPECT_NEAR(view.free_m(2, 1), 2.0, 2e-6) << "the exit is not spread to a neighbour";
  EXPECT_FALSE(prepared(view).has_islands);
}

TEST(View, IgnoredPocketsAreKnownFreeBehindTheRobotOnly) {
  SmallCamera c;
  c.policies.robot_pockets = Policy::ignored;
  c.policies.ignored_pocket_m = 0.25;
  c.near_m = std::vector<float>(20, 1.5F);
  c.far_m = std::vector<float>(20, 2.5F);
  c.units[0] = 2600;  // behind the exit, within the pocket: no robot pixel
  c.units[1] = 1000;  // before the robot
  c.far_m[2] = 1.9F;  // the reading lies behind the robot
  const View view = c.view();
  EXPECT_NEAR(view.free_m(0, 0), 2.6, 2e-6);
  EXPECT_NEAR(view.free_m(1, 0), 1.0, 2e-6);
  EXPECT_EQ(prepared(view).island_far_m.at(1, 0), 2.5F) << "an island is the robot without the pocket";
  EXPECT_NEAR(view.free_m(2, 0), 2.0, 2e-6);
  EXPECT_NEAR(view.free_m(3, 0), 2.75, 2e-6);
  c.policies = {Policy::obstacle, Policy::obstacle, Policy::obstacle, 0};
  EXPECT_EQ(c.view().free_m(3, 0), 2.5F);
}

TEST(View, ASmallHoleFreesSpaceAndIsNoReading) {
  SmallCamera c;
  c.camera.intrinsics = {20, 16, 100, 100, 10, 8};
  c.units = std::vector<std::uint16_t>(320, 2000);
  c.units[8 * 20 + 10] = 0;
  c.near_m = c.far_m = std::vector<float>(320, 0.0F);
  const Frame frame{depth_view(c.units, 20, 16, 0.001), {}, 1.0};
  const auto free_m = [&](double smallest_obstacle_m) {
    c.margins.smallest_obstacle_m = smallest_obstacle_m;
    View view(c.camera, c.margins, c.policies);
    EXPECT_TRUE(view.update(frame, Pose::Identity()));
    EXPECT_EQ(view.measured_m(10, 8), 0.0F) << smallest_obstacle_m;
    EXPECT_EQ(view.measured_m(9, 8), 2.0F) << smallest_obstacle_m;
    return static_cast<double>(view.free_m(10, 8));
  };
  EXPECT_EQ(free_m(0), 0.0);
  const double at_the_corner_px = 100 / std::hypot(1, 0.1, 0.08);
  EXPECT_NEAR(free_m(0.02), 0.02 * at_the_corner_px / 2 - 0.01, 1.1e-3)
      << "s f / W less half of s: nearer, it would be wider";
  EXPECT_NEAR(free_m(0.08), 2.0 - 0.04, 1.1e-3) << "what stands around it less half of s";
}

TEST(View, FreesNothingWhenTheFrameIsUnusable) {
  SmallCamera c;
  View view(c.camera, c.margins, c.policies);
  EXPECT_FALSE(view.present());
  EXPECT_EQ(view.free_m(2, 2), 0.0F);
  Frame broken = c.frame();
  const auto refused = [&](const char* why) {
    ASSERT_TRUE(view.update(c.frame(), Pose::Identity()));
    EXPECT_GT(view.free_m(2, 2), 1.9F);
    EXPECT_FALSE(view.update(broken, Pose::Identity())) << why;
    EXPECT_FALSE(view.present()) << why;
    EXPECT_FALSE(prepared(view).has_islands) << why;
    EXPECT_TRUE(std::isnan(view.time_s())) << why;
    for (int v = 0; v < 4; ++v) {
      for (int u = 0; u < 5; ++u) {
        EXPECT_EQ(view.free_m(u, v), 0.0F) << why;
        EXPECT_EQ(view.measured_m(u, v), 0.0F) << why;
      }
    }
    EXPECT_EQ(prepared(view).minima_m[0], 0.0F) << why;
    broken = c.frame();
  };
  broken.depth.data = nullptr;
  refused("no data");
  broken.depth.width_px = 4;
  refused("another width");
  broken.depth.height_px = 5;
  refused("another height");
  broken.depth.stride_bytes = 8;
  refused("rows that overlap");
  broken.depth.metres_per_unit = 0.0001;
  refused("another scale");
  broken.robot.far_m = nullptr;
  refused("half a robot view");
  broken.robot.stride_px = 4;
  refused("robot rows that overlap");
}

TEST(View, UpdatesWithoutAllocation) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const test::RandomRun run{1, 30};
  std::mt19937_64 random(run.seed);
  for (std::int64_t n = 0; n < run.count; ++n) {
    const RandomCamera c = random_camera(64, 48, random);
    const RandomFrame frame(c, random);
    View view(c.camera, c.margins, c.policies);
    const test::AllocationGuard guard;
    view.update(frame.frame(), Pose::Identity());
    view.update(Frame{}, Pose::Identity());
    EXPECT_EQ(guard.allocations(), 0);
  }
}

}  // namespace
}  // namespace depthgrid::views
