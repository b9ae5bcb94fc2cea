#include "depthgrid/avoidance/padded_cell.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::avoidance {

namespace {

constexpr double kAround_m = 0.05;  ///< how far a camera alone is asked for what it sees free
constexpr double kRecorded_s = 3600;

/// The pixel of the place shows the padded robot, or what is in or behind it, and the robot is before the place.
bool is_behind_robot(const RigCamera& camera, const views::Settings& settings, const Frame& frame,
                     const Eigen::Vector3d& place_world) noexcept {
  const Eigen::Vector3d x = camera.T_world_camera.inverse(Eigen::Isometry) * place_world;
  const DepthPoint at = project(camera.intrinsics, x);
  const auto u = static_cast<int>(std::floor(at.x_px));
  const auto v = static_cast<int>(std::floor(at.y_px));
  if (frame.robot.near_m == nullptr || !camera.intrinsics.contains(u, v)) {
    return false;
  }
  const double near_m = frame.robot.near_m[v * frame.robot.stride_px + u];
  const double depth_m = measured_depth_m(frame.depth, camera.rule, u, v).value_or(0);
  const double highest_m = depth_m + depth_margin_m(settings.margins.front().sensor, depth_m);
  return near_m > 0 && near_m < x.z() && depth_m > 0 && highest_m >= near_m;
}

}  // namespace

PaddedCell::PaddedCell(const PaddingProblem& problem, double padding_m)
    : problem_(problem), frames_(problem.rig.cameras.size()) {
  robot::RemovalSettings removal = problem.settings.removal;
  removal.padding_m = padding_m;
  for (const RigCamera& camera : problem.rig.cameras) {
    removals_.emplace_back(camera.intrinsics, problem.removed, removal);
  }
}

std::span<const Frame> PaddedCell::frames(std::size_t cell) {
  const EmptyCell& seen = problem_.cells[cell];
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const Frame& frame = seen.seen[k];
    const Pose& T_world_camera = problem_.rig.cameras[k].T_world_camera;
    frames_[k] = {frame.depth, removals_[k].find(seen.T_world_link, T_world_camera, seen.motion_m, &frame.depth),
                  frame.time_s};
  }
  return frames_;
}

PaddedCell::Alone PaddedCell::alone(std::size_t cell, std::size_t camera, const Eigen::Vector3d& place_world) {
  const std::span<const Frame> all = frames(cell);
  const Frame& frame = all[camera];
  const double behind_s = newest_s(all) - frame.time_s;
  Alone result;
  result.says.camera = camera;
  if (behind_s > problem_.settings.evaluator.max_image_age_s) {
    result.says.state = ProximityState::unmeasured;
    result.says.unmeasured = Unmeasured::late_image;
    return result;
  }
  // The same search with this camera alone, in a small box, where what it does not look at counts: so the place is what
  // it lies in for this camera, with all its margins.
  Rig rig{.name = problem_.rig.name, .cameras = {problem_.rig.cameras[camera]}, .T_floor_world = {}};
  views::Settings settings = problem_.settings.search;
  settings.rho_m = std::max(kAround_m, 4 * settings.resolution_m);
  const Eigen::Vector3d side_m = Eigen::Vector3d::Constant(2 * settings.rho_m);
  settings.space = views::BoxSpace{place_world - side_m, place_world + side_m};
  settings.policies.unobserved = views::Policy::obstacle;
  settings.policies.outside = views::Policy::ignored;
  settings.margins = {settings.margins[camera]};
  settings.margins.front().time_uncertainty_s += behind_s;  // what may have moved until the newest image
  search::EvaluatorOptions options;
  options.max_image_age_s = kRecorded_s;
  search::SearchEvaluator evaluator(rig, settings, options);
  (void)evaluator.update(0, frame);
  const Answer answer = evaluator.distance(Capsule::point(place_world));
  result.says.state =
      answer.nearest.distance_m > settings.resolution_m ? ProximityState::beyond_rho : answer.nearest.state;
  result.says.unmeasured = answer.nearest.unmeasured;
  result.around_m = answer.nearest.distance_m;
  result.says.behind_robot = result.says.state == ProximityState::occluded &&
                             is_behind_robot(rig.cameras.front(), settings, frame, place_world);
  return result;
}

double newest_s(std::span<const Frame> frames) noexcept {
  return std::max_element(frames.begin(), frames.end(),
                          [](const Frame& a, const Frame& b) { return a.time_s < b.time_s; })
      ->time_s;
}

std::vector<std::vector<Answer>> answers_with(const PaddingProblem& problem, double padding_m) {
  search::EvaluatorOptions options = problem.settings.evaluator;
  options.directions = 0;
  options.budget = {};  // a lower bound would read as something near
  search::SearchEvaluator evaluator(problem.rig, problem.settings.search, options);
  PaddedCell padded(problem, padding_m);
  std::vector<Capsule> capsules(problem.asked.size());
  std::vector<std::vector<Answer>> result;
  for (std::size_t i = 0; i < problem.cells.size(); ++i) {
    const std::span<const Frame> frames = padded.frames(i);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      if (const FrameUpdate update = evaluator.update(k, frames[k]); !update.taken()) {
        fail("least padding: cell ", i, ", camera '", problem.rig.cameras[k].id, "': ", update.reason);
      }
    }
    if (i >= problem.settings.warm_up) {
      robot::place(problem.asked, problem.cells[i].T_world_link, capsules);
      result.emplace_back(capsules.size());
      evaluator.evaluate(capsules, newest_s(frames), result.back());
    }
  }
  return result;
}

double reach_m(const PaddingProblem& problem, double padding_m) {
  PaddedCell padded(problem, padding_m);
  double farthest_m = 0;
  for (std::size_t i = 0; i < problem.cells.size(); ++i) {
    for (const Frame& frame : padded.frames(i)) {
      if (frame.robot.near_m == nullptr) {
        fail("least padding: cell ", i,
             ": the robot cannot be found in an image: a pose or a motion is not finite, or "
             "there is not one motion a capsule");
      }
      farthest_m = std::max(farthest_m, frame.robot.reach_m);
    }
  }
  return farthest_m;
}

}  // namespace depthgrid::avoidance
