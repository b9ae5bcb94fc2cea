// The rule for holes of the prepared images against the oracle's, pixel by pixel.
#include "reference/hole_readings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "depthgrid/views/hole_rule.hpp"
#include "reference/search_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::reference {
namespace {

std::vector<float> readings_m(const DepthView& depth, const MeasurementRule& rule) {
  std::vector<float> result;
  for (int v = 0; v < depth.height_px; ++v) {
    for (int u = 0; u < depth.width_px; ++u) {
      result.push_back(measured_depth_m(depth, rule, u, v).value_or(0.0F));
    }
  }
  return result;
}

TEST(HoleReadings, AreThoseOfThePreparedImages) {
  const test::RandomRun run = test::random_run(30);
  std::int64_t filled = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    RandomOptions options;
    options.seed = run.seed + static_cast<std::uint64_t>(i);
    options.smallest_m = 0.01 + 0.15 * static_cast<double>(i % 7) / 7 + 1e-5 * static_cast<double>(i);
    options.missing = false;
    const SearchProblem problem = make_search_problem(options, 1);
    for (std::size_t k = 0; k < problem.rig.cameras.size(); ++k) {
      const RigCamera& camera = problem.rig.cameras[k];
      const SensorMargin& margin = problem.settings.margins[k].sensor;
      const DepthView& depth = problem.frames[k].depth;
      views::HoleRule rule(camera.intrinsics, camera.metres_per_unit, camera.rule, margin, *options.smallest_m);
      DepthView strided = depth;
      strided.stride_bytes = row_bytes(depth.format, depth.width_px);
      const std::vector<float> ours_m = readings_m(rule.fill(strided), camera.rule);
      const std::vector<float> before_m = readings_m(strided, camera.rule);
      const std::vector<float> oracle_m =
          with_holes_filled(before_m, camera.intrinsics, camera.rule, margin, strided, *options.smallest_m);
      for (std::size_t p = 0; p < ours_m.size(); ++p) {
        filled += before_m[p] == 0 && ours_m[p] > 0 ? 1 : 0;
        ASSERT_NEAR(static_cast<double>(ours_m[p]), static_cast<double>(oracle_m[p]), 1e-6)
            << problem.line(0) << " camera " << k << ", pixel " << p % depth.width_px << ", " << p / depth.width_px
            << ", units " << (depth.format == DepthFormat::uint16_units) << ", W "
            << rule.width_px(static_cast<int>(p) % depth.width_px, static_cast<int>(p) / depth.width_px) << ", focal "
            << camera.intrinsics.fx_px << ' ' << camera.intrinsics.fy_px << " near " << camera.rule.near_m;
      }
    }
  }
  EXPECT_GT(filled, 100 * run.count);
}

}  // namespace
}  // namespace depthgrid::reference
