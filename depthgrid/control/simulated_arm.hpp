// An arm that goes where it is told, as fast as its own limits let it, some periods late.
#pragma once

#include <array>
#include <cstdint>

#include "depthgrid/control/command_limiter.hpp"
#include "depthgrid/control/robot_port.hpp"

namespace depthgrid::control {

/// Most periods between a command and its effect.
inline constexpr int kMaxLatency = 64;

/// A kinematic integrator behind the robot's interface. Nothing but the constructor allocates, locks or throws.
class SimulatedArm final : public RobotPort {
 public:
  /// At rest at `position_rad`. `latency`: a command takes effect in the advance() that many periods later; 0: in the
  /// next. Throws Error when limits, period or latency are invalid or the position is not within the limits.
  SimulatedArm(const JointLimits& limits, double period_s, const JointVector& position_rad, int latency = 0);

  [[nodiscard]] bool read(JointState& state) noexcept override;
  /// Kept until the next advance(); false when not finite or of another size.
  [[nodiscard]] bool write(const JointCommand& command) noexcept override;

  /// One period: each joint goes to its commanded position. Where its limits forbid that, it goes there as fast as they
  /// let it, and the command counts as not followed.
  void advance() noexcept;

  /// Commands so far that the limits did not let it follow exactly (to 1e-9 rad/s).
  [[nodiscard]] std::int64_t not_followed() const noexcept { return not_followed_; }

 private:
  CommandLimiter motion_;
  std::array<JointVector, kMaxLatency + 1> commanded_;  ///< positions on their way, a ring
  int latency_;
  std::int64_t periods_ = 0;
  std::int64_t not_followed_ = 0;
};

}  // namespace depthgrid::control
