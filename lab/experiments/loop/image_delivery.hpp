// Images on their way from simulated cameras to the loop, in simulated time.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "depthgrid/robot/frame_intake.hpp"
#include "lab/experiments/loop/avoidance_cell.hpp"
#include "lab/experiments/loop/avoidance_method.hpp"

namespace depthgrid::experiments {

/// Called with the measured images of each frame; may be empty.
using OnFrame = std::function<void(double time_s, std::span<const DepthImage> measured_m)>;

/// One thread.
class ImageDelivery {
 public:
  /// Everything but `on_frame` must outlive it. Throws Error as FrameIntake does.
  ImageDelivery(const Rig& rig, const robot::RobotModel& model, const robot::JointHistory& history, AvoidanceCell& cell,
                DistanceEvaluator& evaluator, const AvoidanceSettings& settings, std::uint64_t seed, OnFrame on_frame);

  /// All cameras take an image of the cell as it is now.
  void expose(double time_s);

  /// Hands the evaluator what was exposed settings.frame_latency_s ago or earlier. Throws Error when it does not take
  /// it: what follows would be measured as if it were the method's.
  void deliver(double time_s);

 private:
  struct Exposure {
    double time_s = 0;
    std::vector<DepthImage> measured_m;
  };

  const Rig& rig_;
  AvoidanceCell& cell_;
  DistanceEvaluator& evaluator_;
  const AvoidanceSettings& settings_;
  OnFrame on_frame_;
  robot::FrameIntake intake_;
  simulation::SimulatedSensors sensors_;
  std::vector<DepthImage> ideal_m_;
  std::deque<Exposure> on_the_way_;
  std::uint64_t frame_number_ = 0;
};

}  // namespace depthgrid::experiments
