// The methods that the avoidance experiments compare: where distances come from, and what the controller makes of them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "depthgrid/control/polygon_task.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/robot/robot_at_exposure.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "lab/experiments/loop/avoidance_motion.hpp"

namespace depthgrid::experiments {

enum class Method : std::uint8_t {
  none,            ///< no avoidance
  letter_one,      ///< the letter's evaluation with the principal camera alone, robot pixels taken out of the image
  letter_two,      ///< the letter's evaluation with both cameras
  search,          ///< the sound search with both cameras: all that nobody sees is an obstacle
  search_pockets,  ///< the same, with the declared policy that ignores pockets right behind the robot
  search_memory,   ///< the search with_declarations() and a memory of what was seen free
};
inline constexpr std::array kMethods{Method::none, Method::letter_one, Method::letter_two, Method::search,
                                     Method::search_pockets};
inline constexpr std::array kAllMethods{Method::none,   Method::letter_one,     Method::letter_two,
                                        Method::search, Method::search_pockets, Method::search_memory};
[[nodiscard]] constexpr bool is_search(Method method) noexcept {
  return method == Method::search || method == Method::search_pockets || method == Method::search_memory;
}

/// As in tables ("letter, 2 cameras"), and in JSON ("letter_two").
[[nodiscard]] std::string_view title(Method method) noexcept;
[[nodiscard]] std::string_view key(Method method) noexcept;
/// 0 for `none`.
[[nodiscard]] int cameras_of(Method method) noexcept;

inline constexpr double kFrameRate_hz = 30;  ///< of every camera

/// What all runs of one comparison share.
struct AvoidanceSettings {
  int width_px = 160;
  std::string_view sensor = "ideal";
  double period_s = 0.002;
  double frame_latency_s = 0.02;   ///< from the exposure until the loop has the image
  double rho_m = 0.4;              ///< of the control laws, and of the letter's evaluation
  double repulsion_m_s = 1.5;      ///< V_max
  double v_max_m_s = 2.0;          ///< of obstacles, for the search
  double ignored_pocket_m = 0.10;  ///< of Method::search_pockets
  double resolution_m = 0.01;      ///< of the search
  double approach_gain_per_s = 2.0;
  double approach_stop_m = 0.03;
  double removal_padding_m = 0.01;
  bool margin_in_test = false;     ///< robot::RemovalSettings
  double memory_padding_m = 0.01;  ///< of Method::search_memory, instead of removal_padding_m
  bool memory_margin_in_test = false;
  double known_layer_m = 0;  ///< that the laws keep clear: the search looks so much farther
  int evaluate_every = 2;    ///< periods between two evaluations, of every method
};

/// Both cameras such sensors, the padding of the removal their margin at 2.5 m in whole centimetres. In images of 320
/// pixels a hole of a pixel is as wide as a Kinect's smallest obstacle at the robot's distance. Throws Error when there
/// is no such sensor.
[[nodiscard]] AvoidanceSettings sensor_settings(std::string_view sensor, int width_px);

/// Joints at the beginning, the flange before the base and above the floor; hexagon in the plane y = const around it.
[[nodiscard]] control::JointVector start_rad();
[[nodiscard]] Eigen::Vector3d hexagon_centre_world(const robot::RobotModel& model);

/// What the flange passes.
[[nodiscard]] control::PolygonSettings hexagon(const robot::RobotModel& model, double radius_m = kHexagonRadius_m);

[[nodiscard]] views::Settings search_settings(const Rig& rig, const AvoidanceSettings& settings,
                                              double ignored_pocket_m = 0);

/// With the padding of the method.
[[nodiscard]] AvoidanceSettings settings_for(Method method, const AvoidanceSettings& settings);

[[nodiscard]] robot::ExposureSettings exposure_settings(const AvoidanceSettings& settings);

/// The search names the direction of the first part. The letter's answers points only, so its loop asks about points.
/// `budget`: the search's.
[[nodiscard]] std::unique_ptr<DistanceEvaluator> make_evaluator(Method method, const Rig& rig,
                                                                const AvoidanceSettings& settings,
                                                                const search::Budget& budget = {});

[[nodiscard]] avoidance::LoopSettings loop_settings(Method method, const robot::RobotModel& model,
                                                    const AvoidanceSettings& settings);

}  // namespace depthgrid::experiments
