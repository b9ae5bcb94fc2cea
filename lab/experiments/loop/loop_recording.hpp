// A run of the loop kept for the real clock: joint positions of every period, images of every frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "depthgrid/control/robot_port.hpp"
#include "depthgrid/core/rig.hpp"
#include "lab/experiments/loop/avoidance_run.hpp"

namespace depthgrid::experiments {

/// Played forwards, backwards and so on, so that it has no end and nothing jumps.
class LoopRecording {
 public:
  /// Runs the loop of a search in simulated time beside a person who carries a box. Throws Error as its parts do.
  LoopRecording(const AvoidanceSettings& settings, double duration_s, std::uint64_t seed,
                Method method = Method::search);

  [[nodiscard]] Method method() const noexcept { return method_; }
  [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
  [[nodiscard]] double period_s() const noexcept { return period_s_; }
  [[nodiscard]] const std::string& motion() const noexcept { return motion_; }
  [[nodiscard]] std::size_t frames() const noexcept { return frames_.size(); }

  /// Joint positions in period k, k >= 0.
  [[nodiscard]] const control::JointVector& joints(std::int64_t period) const noexcept;
  /// The frame that is exposed in period k, if any: views on 16-bit images, one a camera.
  [[nodiscard]] std::optional<std::size_t> frame_at(std::int64_t period) const noexcept;
  /// As if exposed at this time.
  [[nodiscard]] std::vector<Frame> seen(std::size_t frame, double time_s) const;
  /// The period in which a frame is exposed first.
  [[nodiscard]] std::int64_t period_of(std::size_t frame) const noexcept { return frames_[frame].period; }

 private:
  struct RecordedFrame {
    std::int64_t period = 0;
    std::vector<std::vector<std::uint16_t>> images;
    std::vector<DepthView> views;
  };
  [[nodiscard]] std::int64_t there_and_back(std::int64_t period) const noexcept;

  Method method_;
  Rig rig_;
  double period_s_;
  std::string motion_;
  std::vector<control::JointVector> joints_;
  std::vector<RecordedFrame> frames_;
  std::vector<std::int64_t> frame_of_period_;  ///< -1: none
};

/// The arm that stands wherever the recording says, at a time that the caller says, and goes nowhere else.
class RecordedArm final : public control::RobotPort {
 public:
  explicit RecordedArm(const LoopRecording& recording) : recording_(recording) {}
  void set_period(std::int64_t period, double time_s) noexcept {
    period_ = period;
    time_s_ = time_s;
  }
  [[nodiscard]] bool read(control::JointState& state) noexcept override;
  [[nodiscard]] bool write(const control::JointCommand& command) noexcept override;

 private:
  const LoopRecording& recording_;
  std::int64_t period_ = 0;
  double time_s_ = 0;
};

}  // namespace depthgrid::experiments
