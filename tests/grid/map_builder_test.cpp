// Building maps: the same table whatever the number of threads, progress, cancelling, and refusing what does not fit.
#include "depthgrid/grid/map/map_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

#include "depthgrid/grid/map/machine_memory.hpp"
#include "depthgrid/grid/map/parallel_for.hpp"
#include "grid/map_rigs.hpp"

namespace depthgrid::grid {
namespace {

using testing::HasSubstr;

template <class Span>
bool same_bytes(const Span& a, const Span& b) {
  return a.size_bytes() == b.size_bytes() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

MapCalibration bench_rig() {
  MapCalibration rig;
  rig.principal = {40, 30, 32.8, 32.8, 20, 15};
  rig.quantisation = {0.3, 0.05, 0.0, 60};
  const Pose beside = look_at({2, 0, 1}, {0, 0, 1.5}, {0, -1, 0});
  const Pose facing = look_at({0.2, 0.1, 4}, {0, 0, 1.5}, {0, -1, 0});
  rig.secondaries = {{{40, 30, 32.8, 32.8, 20, 15}, beside.inverse()}, {{30, 20, 25, 25, 15, 10}, facing.inverse()}};
  return rig;
}

TEST(MapBuilder, TableDoesNotDependOnThreads) {
  const MapCalibration rig = bench_rig();
  const DepthGrid grid = grid_of(rig);
  MapBuildSettings one;
  one.threads = 1;
  const OnePixelMap pixels = build_one_pixel_map(grid, rig.secondaries, one);
  const PixelListMap lists = build_pixel_list_map(grid, rig.secondaries, one);
  for (const int threads : {2, 3, 7}) {
    MapBuildSettings many;
    many.threads = threads;
    EXPECT_TRUE(same_bytes(build_one_pixel_map(grid, rig.secondaries, many).cells(), pixels.cells())) << threads;
    const PixelListMap other = build_pixel_list_map(grid, rig.secondaries, many);
    EXPECT_TRUE(same_bytes(other.tables().rays, lists.tables().rays)) << threads;
    EXPECT_TRUE(same_bytes(other.tables().cells, lists.tables().cells)) << threads;
    EXPECT_TRUE(same_bytes(other.tables().rows, lists.tables().rows)) << threads;
  }
}

TEST(MapBuilder, ReportsProgressOnTheCallersThread) {
  const MapCalibration rig = bench_rig();
  std::vector<MapBuildProgress> reports;
  MapBuildSettings settings;
  const std::thread::id here = std::this_thread::get_id();
  settings.progress = [&](const MapBuildProgress& progress) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    reports.push_back(progress);
    return true;
  };
  build_pixel_list_map(grid_of(rig), rig.secondaries, settings);
  ASSERT_FALSE(reports.empty());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].total, 2 * 30 * 2);
    EXPECT_TRUE(i == 0 || reports[i].done >= reports[i - 1].done);
    EXPECT_EQ(reports[i].seconds_left.has_value(), reports[i].done > 0);
  }
  EXPECT_EQ(reports.back().done, reports.back().total);
  EXPECT_EQ(reports.back().seconds_left, 0.0);
}

TEST(MapBuilder, CallbackCancels) {
  const MapCalibration rig = bench_rig();
  MapBuildSettings settings;
  settings.progress = [](const MapBuildProgress&) { return false; };
  EXPECT_THROW(build_one_pixel_map(grid_of(rig), rig.secondaries, settings), MapBuildCancelled);
  EXPECT_THROW(build_pixel_list_map(grid_of(rig), rig.secondaries, settings), MapBuildCancelled);
}

TEST(MapBuilder, PassesOnWhatTheCallbackThrows) {
  const MapCalibration rig = bench_rig();
  MapBuildSettings settings;
  settings.progress = [](const MapBuildProgress&) -> bool { throw std::logic_error("mine"); };
  EXPECT_THROW(build_one_pixel_map(grid_of(rig), rig.secondaries, settings), std::logic_error);
}

TEST(MapBuilder, StatesTheMemoryThatItTakes) {
  const MapCalibration rig = bench_rig();
  const DepthGrid grid = grid_of(rig);
  const MapMemory one_pixel = estimate_map_memory(grid, rig.secondaries, MapStorage::one_pixel);
  EXPECT_EQ(one_pixel.bytes, 40U * 30U * 60U * 2U * 8U);
  EXPECT_EQ(one_pixel.safety_factor, 1.0);
  EXPECT_EQ(table_bytes(build_one_pixel_map(grid, rig.secondaries)), one_pixel.bytes);

  const MapMemory lists = estimate_map_memory(grid, rig.secondaries, MapStorage::pixel_lists);
  EXPECT_GT(lists.safety_factor, 1.0);
  const auto taken = static_cast<double>(table_bytes(build_pixel_list_map(grid, rig.secondaries)));
  EXPECT_LE(taken, static_cast<double>(lists.bytes));
  EXPECT_GE(taken * lists.safety_factor * 1.1, static_cast<double>(lists.bytes));
  EXPECT_EQ(estimate_map_memory(grid, rig.secondaries, MapStorage::closed_form).bytes, 0U);
}

TEST(MapBuilder, FewRaysAreCountedExactly) {
  MapCalibration rig = bench_rig();
  rig.principal = {20, 15, 16.4, 16.4, 10, 7.5};
  const MapMemory lists = estimate_map_memory(grid_of(rig), rig.secondaries, MapStorage::pixel_lists);
  EXPECT_EQ(lists.safety_factor, 1.0);
  EXPECT_EQ(table_bytes(build_pixel_list_map(grid_of(rig), rig.secondaries)), lists.bytes);
}

TEST(MapBuilder, RefusesWhatDoesNotFit) {
  const MapCalibration rig = bench_rig();
  const DepthGrid grid = grid_of(rig);
  for (const MapStorage storage : {MapStorage::one_pixel, MapStorage::pixel_lists}) {
    MapBuildSettings settings;
    settings.memory_limit_bytes = 1000;
    bool started = false;
    settings.progress = [&](const MapBuildProgress&) { return started = true; };
    try {
      build_map(grid, rig.secondaries, storage, settings);
      ADD_FAILURE() << "fitted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("more than the 1000 available"));
    }
    EXPECT_FALSE(started);
  }
  MapBuildSettings enough;
  enough.memory_limit_bytes = estimate_map_memory(grid, rig.secondaries, MapStorage::one_pixel).bytes;
  EXPECT_NO_THROW(build_one_pixel_map(grid, rig.secondaries, enough));
}

TEST(MapBuilder, RefusesWithoutCamera) {
  EXPECT_THROW(build_one_pixel_map(grid_of(bench_rig()), {}), Error);
  EXPECT_THROW(build_pixel_list_map(grid_of(bench_rig()), {}), Error);
}

TEST(MapBuilder, CheckMatchesNamesWhatDiffers) {
  const MapCalibration rig = bench_rig();
  const DepthGrid grid = grid_of(rig);
  const auto message = [&](const DepthGridMap& map, const DepthGrid& wanted,
                           std::span<const SecondaryCamera> secondaries) -> std::string {
    try {
      check_matches(map, wanted, secondaries);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  for (const MapStorage storage : {MapStorage::closed_form, MapStorage::one_pixel, MapStorage::pixel_lists}) {
    const DepthGridMap map = build_map(grid, rig.secondaries, storage);
    EXPECT_EQ(message(map, grid, rig.secondaries), "");
    std::vector<SecondaryCamera> moved = rig.secondaries;
    moved[1].T_secondary_principal.translation().x() += 1e-3;
    PinholeCamera other = rig.principal;
    other.fy_px += 0.5;
    const std::string by_pose = message(map, grid, moved);
    const std::string by_focal_length = message(map, DepthGrid(other, rig.quantisation), rig.secondaries);
    const std::string by_count = message(map, grid, std::span(rig.secondaries).first(1));
    EXPECT_THAT(by_pose, HasSubstr("another calibration"));
    EXPECT_THAT(by_focal_length, HasSubstr("another calibration"));
    EXPECT_THAT(by_count, HasSubstr("another calibration"));
    if (storage != MapStorage::closed_form) {
      EXPECT_THAT(by_pose, HasSubstr("secondary camera 1: T_secondary_principal(0, 3)"));
      EXPECT_THAT(by_focal_length, HasSubstr("principal camera: fy [px] is 32.8 in the map, wanted is 33.3"));
      EXPECT_THAT(by_count, HasSubstr("made for 2 secondary cameras, wanted are 1"));
    }
  }
}

TEST(MapBuilder, NumbersGoThereAndBack) {
  const MapCalibration rig = bench_rig();
  std::vector<double> values;
  for (const CalibrationNumber& number : numbers(rig)) {
    values.push_back(number.value);
  }
  const MapCalibration back = calibration_from_numbers(values, "test");
  EXPECT_EQ(difference(rig, back), "");
  EXPECT_EQ(fingerprint(rig), fingerprint(back));
  values.back() += 1e-12;
  const MapCalibration nearly = calibration_from_numbers(values, "test");
  EXPECT_NE(fingerprint(rig), fingerprint(nearly));
  EXPECT_EQ(difference(rig, nearly), "") << "machines may round differently";
  values[0] = 40.5;
  EXPECT_THROW(calibration_from_numbers(values, "test"), Error);
}

TEST(ParallelFor, DoesEveryPieceOnceAndPassesErrorsOn) {
  std::vector<std::atomic<int>> done(1000);
  EXPECT_TRUE(parallel_for(done.size(), 4, [&](std::size_t i) { ++done[i]; }, {}));
  for (const std::atomic<int>& times : done) {
    EXPECT_EQ(times, 1);
  }
  EXPECT_TRUE(parallel_for(0, 4, [](std::size_t) {}, {}));
  EXPECT_THROW(parallel_for(100, 4,
                            [](std::size_t i) {
                              if (i == 7) {
                                throw std::logic_error("mine");
                              }
                            },
                            {}),
               std::logic_error);
}

TEST(MachineMemory, IsPlausible) { EXPECT_GT(available_memory_bytes(), std::uint64_t{1} << 20U); }

}  // namespace
}  // namespace depthgrid::grid
