#include "lab/experiments/loop/avoidance_method.hpp"

#include <cmath>
#include <numbers>

#include "depthgrid/avoidance/model_limits.hpp"
#include "depthgrid/avoidance/nothing_near.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/simulation/arrangement.hpp"
#include "depthgrid/views/surveillance_radius.hpp"
#include "lab/experiments/stage/declared_rig.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kAcceleration_rad_s2 = 300 * std::numbers::pi / 180;

}  // namespace

std::string_view title(Method method) noexcept {
  constexpr std::array<std::string_view, 6> kTitles{
      "no avoidance",      "letter, 1 camera",        "letter, 2 cameras",
      "search, 2 cameras", "search, pockets ignored", "search with memory"};
  return kTitles.at(static_cast<std::size_t>(method));
}

std::string_view key(Method method) noexcept {
  constexpr std::array<std::string_view, 6> kKeys{"none",   "letter_one",     "letter_two",
                                                  "search", "search_pockets", "search_memory"};
  return kKeys.at(static_cast<std::size_t>(method));
}

int cameras_of(Method method) noexcept { return method == Method::none ? 0 : method == Method::letter_one ? 1 : 2; }

AvoidanceSettings sensor_settings(std::string_view sensor, int width_px) {
  AvoidanceSettings settings;
  settings.sensor = sensor_model(sensor).name;
  settings.width_px = width_px;
  settings.memory_padding_m = thin_padding_m(sensor);
  settings.memory_margin_in_test = true;
  if (settings.sensor == "ideal") {
    return settings;
  }
  constexpr double kRobotsDistance = 2.5;  // metres
  const Rig rig = simulation::letter_arrangement(sensor).rig;
  const double margin_m = depth_margin_m(rig.cameras.front().margins->sensor, kRobotsDistance);
  settings.removal_padding_m = std::ceil(100 * margin_m) / 100;
  return settings;
}

control::JointVector start_rad() {
  control::JointVector q(7);
  q << std::numbers::pi / 2, 0.1, 0.0, -1.55, 0.0, 1.2, 0.0;
  return q;
}

Eigen::Vector3d hexagon_centre_world(const robot::RobotModel& model) {
  const control::JointVector q = start_rad();
  return robot::PlacedRobot{model}
      .link_poses({q.data(), static_cast<std::size_t>(q.size())})[model.link_index("lwr_7_link")]
      .translation();
}

control::PolygonSettings hexagon(const robot::RobotModel& model, double radius_m) {
  return {.vertices_world = control::vertical_hexagon(hexagon_centre_world(model), radius_m, Eigen::Vector3d::UnitY())};
}

views::Settings search_settings(const Rig& rig, const AvoidanceSettings& settings, double ignored_pocket_m) {
  const simulation::Arrangement letter = simulation::letter_arrangement();
  views::Settings result;
  result.space = views::BoxSpace{letter.workspace_low_world, letter.workspace_high_world};
  result.policies.unobserved = views::Policy::obstacle;
  result.policies.outside = views::Policy::obstacle;
  result.policies.robot_pockets = ignored_pocket_m > 0 ? views::Policy::ignored : views::Policy::obstacle;
  result.policies.ignored_pocket_m = ignored_pocket_m;
  result.margins = camera_margins(rig);
  result.v_max_m_s = settings.v_max_m_s;
  result.resolution_m = settings.resolution_m;
  // An image is at most this old when it is asked: what is beyond rho then still is.
  result.rho_m = views::surveillance_radius_m(settings.rho_m, settings.v_max_m_s,
                                              settings.frame_latency_s + 1 / kFrameRate_hz + settings.period_s,
                                              settings.known_layer_m);
  return result;
}

AvoidanceSettings settings_for(Method method, const AvoidanceSettings& settings) {
  AvoidanceSettings result = settings;
  if (method == Method::search_memory) {
    result.removal_padding_m = settings.memory_padding_m;
    result.margin_in_test = settings.memory_margin_in_test;
    result.known_layer_m = 1.5 * settings.memory_padding_m;  // pixels and margins make it thicker
  }
  return result;
}

robot::ExposureSettings exposure_settings(const AvoidanceSettings& settings) {
  robot::ExposureSettings result;
  result.removal.padding_m = settings.removal_padding_m;
  result.removal.margin_in_test = settings.margin_in_test;
  return result;
}

std::unique_ptr<DistanceEvaluator> make_evaluator(Method method, const Rig& rig, const AvoidanceSettings& settings,
                                                  const search::Budget& budget) {
  if (method == Method::none) {
    return std::make_unique<avoidance::NothingNear>();
  }
  if (is_search(method)) {
    const double pocket_m = method == Method::search_pockets ? settings.ignored_pocket_m : 0;
    search::EvaluatorOptions options{.directions = 1, .budget = budget};
    if (method == Method::search_memory) {
      const simulation::Arrangement letter = simulation::letter_arrangement();
      options.memory = memory::MemorySettings{.low_world = letter.workspace_low_world,
                                              .high_world = letter.workspace_high_world,
                                              .start = memory::StartUnknown{}};
    }
    return std::make_unique<search::SearchEvaluator>(rig, search_settings(rig, settings, pocket_m), options);
  }
  const simulation::Arrangement letter = simulation::letter_arrangement();
  grid::EvaluationSettings grid;
  grid.variant = grid::Variant::letter;
  grid.collect = grid::Collect::hybrid;
  grid.rho_m = settings.rho_m;
  grid.robot_pixels = method == Method::letter_one ? grid::RobotPixels::removed : grid::RobotPixels::case_iv;
  return std::make_unique<grid::GridEvaluator>(
      rig, 0, grid::DepthQuantisation{letter.d_min_m, letter.cell_m, 0, letter.cells}, grid);
}

avoidance::LoopSettings loop_settings(Method method, const robot::RobotModel& model,
                                      const AvoidanceSettings& settings) {
  avoidance::LoopSettings result;
  result.evaluate_every = settings.evaluate_every;
  // As the letter's loop, with a padding of 1 cm. Around a thick layer that has to be known.
  result.blind_layer = method == Method::search_memory ? control::BlindLayer::kept_clear : control::BlindLayer::ignored;
  control::ControllerSettings& controller = result.controller;
  controller.limits = avoidance::joint_limits(model, kAcceleration_rad_s2);
  controller.period_s = settings.period_s;
  controller.posture_rad = start_rad();
  controller.repulsion.rho_m = settings.rho_m;
  controller.repulsion.v_max_m_s = settings.repulsion_m_s;
  controller.body.rho_m = settings.rho_m;
  if (is_search(method)) {
    controller.body.law = control::BodyLaw::approach_row;
    controller.body.gain_per_s = settings.approach_gain_per_s;
    controller.body.stop_m = settings.approach_stop_m;
    result.parts = robot::moving_capsules(model);
    result.end_effector_limits = true;
  } else {
    controller.repulsion.form = control::RepulsionForm::letter;
    result.parts = robot::nine_control_points(model);
  }
  return result;
}

}  // namespace depthgrid::experiments
