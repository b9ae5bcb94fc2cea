// The calls that run for every frame or query allocate nothing, and the counter that says so counts.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/distortion.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pixel_frustum.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid {
namespace {

using test::AllocationGuard;

/// Where pointers go so that the compiler cannot drop an allocation.
void* volatile sink = nullptr;

TEST(AllocationGuard, CountsEveryKindOfAllocation) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  struct alignas(64) Wide {
    std::array<char, 64> bytes{};
  };
  const AllocationGuard guard;
  EXPECT_EQ(guard.allocations(), 0);
  const auto one = std::make_unique<int>(1);
  sink = one.get();
  EXPECT_EQ(guard.allocations(), 1);
  const auto wide = std::make_unique<Wide>();
  sink = wide.get();
  EXPECT_EQ(guard.allocations(), 2);
  void* block = std::malloc(10);
  sink = block;
  EXPECT_EQ(guard.allocations(), 3);
  block = std::realloc(block, 1000);
  sink = block;
  EXPECT_EQ(guard.allocations(), 4);
  std::free(block);
  block = std::calloc(3, 5);
  sink = block;
  EXPECT_EQ(guard.allocations(), 5);
  std::free(block);
  EXPECT_EQ(guard.allocations(), 5);
}

TEST(AllocationGuard, StartsAtZeroAndSeesOnlyItsOwnThread) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  std::int64_t in_thread = -1;
  std::int64_t in_main = -1;
  std::thread other([&in_thread] {
    const AllocationGuard guard;
    const std::vector<int> numbers(100);
    sink = const_cast<int*>(numbers.data());
    in_thread = guard.allocations();
  });
  {
    const AllocationGuard guard;
    other.join();
    in_main = guard.allocations();
  }
  EXPECT_EQ(in_thread, 1);
  EXPECT_EQ(in_main, 0);
}

TEST(NoAllocation, Normalise) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const std::vector<std::uint16_t> units(64 * 48, 1500);
  const std::vector<float> metres(64 * 48, 1.5F);
  const DepthView from_units = depth_view(units, 64, 48, 0.001);
  const DepthView from_metres = depth_view(metres, 64, 48);
  MeasurementRule rule;
  rule.invalid_units = {7, 2047};
  DepthImage image(64, 48);
  const AllocationGuard guard;
  normalise(from_units, rule, image);
  normalise(from_metres, rule, image);
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(NoAllocation, FreeDepthUpdate) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  DepthImage measured(64, 48);
  std::fill_n(measured.data(), 64 * 48, 2.0F);
  const std::vector<float> near_m(64 * 48, 1.0F);
  const std::vector<float> far_m(64 * 48, 3.0F);
  for (const int radius_px : {0, 1, 3}) {
    FreeDepth free_depth(64, 48, {0.01, 0.0, 0.002, radius_px});
    const AllocationGuard guard;
    free_depth.update(measured, {});
    free_depth.update(measured, {near_m.data(), far_m.data(), 64});
    EXPECT_EQ(guard.allocations(), 0);
  }
}

TEST(NoAllocation, UndistortionApply) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const PinholeCamera camera{64, 48, 50, 50, 32, 24};
  const DepthUndistortion undistortion(
      camera, make_distortion(Distortion::Model::plumb_bob, std::array{-0.1, 0.01, 0.001, 0.0, 0.0}), camera, 0);
  const DepthImage source(64, 48);
  DepthImage result(64, 48);
  const AllocationGuard guard;
  undistortion.apply(source, result);
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(NoAllocation, NearestPoint) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const PinholeCamera camera{640, 480, 525, 525, 320, 240};
  const PixelFrustum frustum = pixel_frustum(camera, 600, 10, 1.0, 1.01);
  double sum = 0;
  const AllocationGuard guard;
  sum += nearest_point(frustum, {0.1, 0.2, 1.5}).distance_m;
  sum += squared_distance(frustum, {0.1, 0.2, 1.5});
  sum += nearest_point_letter(camera, 600, 10, 1.0, 1.01, {300, 200, 1.5}).distance_m;
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_GT(sum, 0);
}

}  // namespace
}  // namespace depthgrid
