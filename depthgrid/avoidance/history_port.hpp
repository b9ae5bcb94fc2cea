// A robot's port that remembers where the joints were.
#pragma once

#include <cstdint>

#include "depthgrid/control/robot_port.hpp"
#include "depthgrid/robot/joint_history.hpp"

namespace depthgrid::avoidance {

/// Passes everything on, and puts the positions of every state into the history, at the state's own time, which has to
/// be on the clock of the cameras. A state that is no newer than the one before adds nothing, nor does a period without
/// a state: where the joints were a period ago says nothing about this time, so the history rather has a gap.
class HistoryPort final : public control::RobotPort {
 public:
  /// Both must outlive it.
  HistoryPort(control::RobotPort& port, robot::JointHistory& history) : port_(port), history_(history) {}

  [[nodiscard]] bool read(control::JointState& state) noexcept override;
  /// States that added nothing: no newer than the one before, or not finite. One that grows with every period says that
  /// the states carry no time, or one of another clock.
  [[nodiscard]] std::int64_t refused() const noexcept { return refused_; }
  [[nodiscard]] bool write(const control::JointCommand& command) noexcept override { return port_.write(command); }

 private:
  control::RobotPort& port_;
  robot::JointHistory& history_;
  std::int64_t refused_ = 0;
};

}  // namespace depthgrid::avoidance
