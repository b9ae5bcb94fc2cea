// One run of the avoidance loop in simulated time: deterministic, and watched with true distances every period.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "lab/experiments/loop/avoidance_cell.hpp"
#include "lab/experiments/loop/avoidance_method.hpp"
#include "lab/experiments/loop/image_delivery.hpp"
#include "lab/experiments/loop/run_summary.hpp"

namespace depthgrid::experiments {

/// One instant of a run.
struct RunSample {
  double time_s = 0;
  control::JointVector q_rad;
  Eigen::Vector3d end_effector_world;
  double true_person_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d repulsion_m_s = Eigen::Vector3d::Zero();  ///< of the end effector, world frame
  /// Unit vector from the end effector's part to the nearest obstacle as evaluated; zero where there is none.
  Eigen::Vector3d to_nearest = Eigen::Vector3d::Zero();
  std::vector<double> told_m;  ///< one a part, the end effector first; rho where nothing is near
};

struct RunResult {
  RunSummary summary;
  double duration_s = 0;
  std::int64_t vertices = 0;       ///< reached
  std::vector<RunSample> samples;  ///< every sample_every periods, when asked for
};

/// A run at the exposure of a frame; valid for the call alone.
struct RunInstant {
  double time_s = 0;
  const simulation::Workcell& cell;
  const avoidance::AvoidanceLoop& loop;
  DistanceEvaluator& evaluator;
  std::int64_t vertices = 0;  ///< reached so far
};
/// May be empty. Asking the evaluator changes nothing in the run.
using OnInstant = std::function<void(const RunInstant& instant)>;

struct RunSettings {
  AvoidanceSettings common;
  double duration_s = 8;
  int sample_every = 0;    ///< periods; 0: no samples
  std::uint64_t seed = 1;  ///< of the sensors
  OnFrame on_frame{};
  OnInstant on_instant{};
};

/// Throws Error as its parts do, and when start, cycle or images are refused.
[[nodiscard]] RunResult run_avoidance(Method method, const robot::RobotModel& model, const AvoidanceMotion& motion,
                                      const RunSettings& settings);

}  // namespace depthgrid::experiments
