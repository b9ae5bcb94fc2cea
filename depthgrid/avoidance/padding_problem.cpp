#include <algorithm>
#include <cmath>
#include <functional>

#include "depthgrid/avoidance/padded_cell.hpp"
#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/robot_parts.hpp"

namespace depthgrid::avoidance {

namespace {

constexpr double kRounding_m = 1e-9;
constexpr double kModel_m = 0.02;  ///< deflection, cables, calibration of the joints

}  // namespace

PaddingProblem padding_problem(const Rig& rig, const robot::RobotModel& model, std::span<const EmptyCell> cells,
                               const LeastPaddingSettings& settings) {
  PaddingProblem problem{checked_rig(rig, "the least padding"), cells, settings,
                         robot::link_capsules(model, settings.capsules),
                         robot::moving_capsules(model, settings.least_joints, settings.capsules)};
  if (settings.warm_up >= cells.size()) {
    fail("least padding: ", settings.warm_up, " of ", cells.size(), " cells are for the warm-up, must be fewer");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const EmptyCell& cell = cells[i];
    if (cell.seen.size() != rig.cameras.size() || cell.T_world_link.size() != model.links().size()) {
      fail("least padding: cell ", i, " has ", cell.seen.size(), " images and ", cell.T_world_link.size(),
           " poses, must have one for each of ", rig.cameras.size(), " cameras and ", model.links().size(), " links");
    }
    for (const Frame& frame : cell.seen) {
      if (!std::isfinite(frame.time_s)) {
        fail("least padding: cell ", i, " has an image without time");
      }
    }
  }
  const std::vector<double>& paddings = settings.paddings_m;
  const bool ascends = std::adjacent_find(paddings.begin(), paddings.end(), std::greater_equal<>()) == paddings.end();
  if (paddings.empty() || !ascends || !(paddings.front() >= 0) || !std::isfinite(paddings.back())) {
    fail("least padding: the paddings to test must be finite, not negative and ascend");
  }
  if (!(settings.clearance_m > 0 && std::isfinite(settings.clearance_m))) {
    fail("least padding: the clearance is ", settings.clearance_m, " m, must be above 0");
  }
  for (std::size_t p = 1; p < paddings.size(); ++p) {
    if (paddings[p] - paddings[p - 1] > settings.clearance_m + kRounding_m) {
      fail("least padding: the step from ", paddings[p - 1], " to ", paddings[p], " m is more than the clearance, ",
           settings.clearance_m, " m, and could jump over what stands there");
    }
  }
  if (settings.robot_within_m && !(*settings.robot_within_m >= 0 && std::isfinite(*settings.robot_within_m))) {
    fail("least padding: robot_within_m is ", *settings.robot_within_m, " m, must be finite and not negative");
  }
  return problem;
}

std::vector<double> padding_ladder(double first_m, double last_m, double step_m) {
  if (!(first_m >= 0 && last_m >= first_m && step_m > 0 && (last_m - first_m) / step_m < 1e4)) {
    fail("paddings from ", first_m, " to ", last_m, " m in steps of ", step_m,
         " m: must ascend from 0 or more, in at most 10000 steps");
  }
  std::vector<double> result;
  const auto steps = static_cast<int>(std::floor((last_m - first_m) / step_m + 1e-6));
  for (int i = 0; i <= steps; ++i) {
    result.push_back(first_m + i * step_m);
  }
  return result;
}

double robot_within_m(const Rig& rig, const views::Settings& settings, double reach_m) {
  double most_m = 0;
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const CameraMargins& margins = settings.margins.at(k);
    const double way_m = settings.v_max_m_s * (margins.half_exposure_s + margins.time_uncertainty_s);
    const double pose_m = margins.translation_m + margins.rotation_rad * reach_m + motion_margin_m(margins, way_m);
    const double pixels_m = (2 * margins.sensor.lateral_px + 1) * half_pixel(rig.cameras[k].intrinsics) * reach_m;
    most_m = std::max(
        most_m, 2 * depth_margin_m(margins.sensor, reach_m) + pose_m + pixels_m + 0.5 * margins.smallest_obstacle_m);
  }
  return kModel_m + most_m;
}

}  // namespace depthgrid::avoidance
