#include "depthgrid/control/simulated_arm.hpp"

#include "depthgrid/core/error.hpp"

namespace depthgrid::control {
namespace {

/// A velocity that differs by less is the same: the command's position has been rounded.
constexpr double kSame = 1e-9;

}  // namespace

SimulatedArm::SimulatedArm(const JointLimits& limits, double period_s, const JointVector& position_rad, int latency)
    : motion_(limits, period_s), latency_(latency) {
  if (latency < 0 || latency > kMaxLatency) {
    fail("simulated arm: latency is ", latency, " periods, must be between 0 and ", kMaxLatency);
  }
  if (!motion_.start(position_rad, JointVector::Zero(limits.joints()))) {
    fail("simulated arm: the position must be finite and have ", limits.joints(), " joints");
  }
  for (int i = 0; i < limits.joints(); ++i) {
    if (!(position_rad[i] >= limits.lowest_rad[i] && position_rad[i] <= limits.highest_rad[i])) {
      fail("simulated arm: joint ", i, " begins at ", position_rad[i], " rad, must be between ", limits.lowest_rad[i],
           " and ", limits.highest_rad[i], " rad");
    }
  }
  commanded_.fill(position_rad);
}

bool SimulatedArm::read(JointState& state) noexcept {
  state = {motion_.last().position_rad, motion_.last().velocity_rad_s,
           static_cast<double>(periods_) * motion_.period_s()};
  return true;
}

bool SimulatedArm::write(const JointCommand& command) noexcept {
  if (command.position_rad.size() != motion_.limits().joints() || !command.position_rad.allFinite()) {
    return false;
  }
  commanded_[static_cast<std::size_t>(periods_ % (latency_ + 1))] = command.position_rad;
  return true;
}

void SimulatedArm::advance() noexcept {
  const auto newest = static_cast<std::size_t>(periods_ % (latency_ + 1));
  const auto due = static_cast<std::size_t>((periods_ + 1) % (latency_ + 1));
  const JointVector target = commanded_[due];
  commanded_[due] = commanded_[newest];  // until a newer one is written
  ++periods_;
  const JointVector wanted = (target - motion_.last().position_rad) / motion_.period_s();
  const JointVector possible = clamped(wanted, motion_.box());
  if ((possible - wanted).cwiseAbs().maxCoeff() <= kSame) {
    motion_.start(target, wanted);  // not step(): there rounding would add up
  } else {
    ++not_followed_;
    motion_.step_towards(target);
  }
}

}  // namespace depthgrid::control
