#include "lab/experiments/loop/loop_recording.hpp"

#include <cmath>

#include "depthgrid/robot/kuka_lwr4.hpp"

namespace depthgrid::experiments {

LoopRecording::LoopRecording(const AvoidanceSettings& settings, double duration_s, std::uint64_t seed, Method method)
    : method_(method), rig_(avoidance_rig(2, settings.width_px, settings.sensor)), period_s_(settings.period_s) {
  const AvoidanceMotion motion = carrying_person(rig_, duration_s, seed);
  motion_ = motion.name;
  RunSettings run;
  run.common = settings;
  run.duration_s = duration_s;
  run.sample_every = 1;
  run.seed = seed;
  run.on_frame = [this](double time_s, std::span<const DepthImage> measured_m) {
    if (time_s < 0) {
      return;  // the one before the first period
    }
    RecordedFrame frame;
    frame.period = std::llround(time_s / period_s_);
    for (std::size_t k = 0; k < measured_m.size(); ++k) {
      frame.images.push_back(simulation::in_units(measured_m[k], rig_.cameras[k].metres_per_unit));
    }
    frames_.push_back(std::move(frame));
  };
  const RunResult result = run_avoidance(method, robot::kuka_lwr4(), motion, run);
  for (const RunSample& sample : result.samples) {
    joints_.push_back(sample.q_rad);
  }
  frame_of_period_.assign(joints_.size(), -1);
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    frame_of_period_[static_cast<std::size_t>(frames_[f].period)] = static_cast<std::int64_t>(f);
    for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
      const RigCamera& camera = rig_.cameras[k];
      frames_[f].views.push_back(depth_view(frames_[f].images[k], camera.intrinsics.width_px,
                                            camera.intrinsics.height_px, camera.metres_per_unit));
    }
  }
}

std::int64_t LoopRecording::there_and_back(std::int64_t period) const noexcept {
  const auto count = static_cast<std::int64_t>(joints_.size());
  const std::int64_t at = period % (2 * count);
  return at < count ? at : 2 * count - 1 - at;
}

const control::JointVector& LoopRecording::joints(std::int64_t period) const noexcept {
  return joints_[static_cast<std::size_t>(there_and_back(period))];
}

std::optional<std::size_t> LoopRecording::frame_at(std::int64_t period) const noexcept {
  const std::int64_t frame = frame_of_period_[static_cast<std::size_t>(there_and_back(period))];
  return frame < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(frame));
}

std::vector<Frame> LoopRecording::seen(std::size_t frame, double time_s) const {
  std::vector<Frame> seen;
  for (const DepthView& view : frames_[frame].views) {
    seen.push_back({view, {}, time_s});
  }
  return seen;
}

bool RecordedArm::read(control::JointState& state) noexcept {
  state.position_rad = recording_.joints(period_);
  state.velocity_rad_s = control::JointVector::Zero(state.position_rad.size());
  state.time_s = time_s_;
  return true;
}

bool RecordedArm::write(const control::JointCommand& /*command*/) noexcept { return true; }

}  // namespace depthgrid::experiments
