#include "depthgrid/control/controller.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::control {

void validate(const ControllerSettings& settings) {
  constexpr const char* kName = "controller: ";
  validate(settings.limits);
  validate_period(settings.period_s, "controller");
  validate(settings.repulsion);
  if (settings.pivot) {
    validate(*settings.pivot);
  }
  validate(settings.body);
  validate(settings.saturation);
  if (settings.body.law == BodyLaw::approach_row && settings.saturation.variant == SaturationVariant::basic) {
    fail(kName, "the body law approach_row needs the optimal saturation; the basic one takes risk or approach_speed");
  }
  if (settings.posture_rad.size() != 0 &&
      (settings.posture_rad.size() != settings.limits.joints() || !settings.posture_rad.allFinite())) {
    fail(kName, "the posture has ", settings.posture_rad.size(), " joints, must be finite and have ",
         settings.limits.joints(), ", or none");
  }
  if (!(settings.posture_gain_per_s >= 0 && std::isfinite(settings.posture_gain_per_s))) {
    fail(kName, "posture gain is ", settings.posture_gain_per_s, " 1/s, must be finite and not negative");
  }
  if (!(settings.contact_memory_s >= 0)) {
    fail(kName, "contact memory is ", settings.contact_memory_s, " s, must not be negative");
  }
}

Controller::Controller(const ControllerSettings& settings)
    : settings_(settings), limiter_(settings.limits, settings.period_s), saturation_(settings.saturation) {
  validate(settings);
}

bool Controller::start(const JointVector& position_rad) noexcept {
  return start(JointState{position_rad, JointVector::Zero(position_rad.size()), 0});
}

bool Controller::start(const JointState& state) noexcept {
  if (!limiter_.start(state.position_rad, state.velocity_rad_s)) {
    return false;
  }
  memory_.forget();
  repulsion_before_.setZero();
  return true;
}

Eigen::Vector3d Controller::repulsion(const Obstacle& obstacle) noexcept {
  const Eigen::Vector3d straight = repulsive_velocity(obstacle, settings_.repulsion);
  const Eigen::Vector3d before = repulsion_before_;
  repulsion_before_ = straight;
  return settings_.pivot ? pivoted(straight, before, settings_.period_s, *settings_.pivot) : straight;
}

JointVector Controller::posture_velocity() const noexcept {
  if (settings_.posture_rad.size() == 0) {
    return {};
  }
  return settings_.posture_gain_per_s * (settings_.posture_rad - limiter_.last().position_rad);
}

CycleOutput Controller::brake() noexcept {
  memory_.forget();
  repulsion_before_.setZero();
  CycleOutput output;
  output.box = limiter_.box();
  output.command = limiter_.step(JointVector::Zero(settings_.limits.joints()));
  return output;
}

CycleOutput Controller::cycle(const CycleInput& input) noexcept {
  CycleOutput output;
  const auto complete = [this](const Obstacle& obstacle, std::size_t point) {
    return memory_.completed(obstacle, point, settings_.period_s, settings_.contact_memory_s);
  };

  const Obstacle at_tip = complete(input.end_effector, 0);
  output.repulsion_m_s = repulsion(at_tip);
  tasks_[0] = input.task;
  if (!at_tip.direction_world) {
    tasks_[0].velocity *= 1.0 - risk(at_tip, settings_.repulsion.rho_m, settings_.repulsion.alpha);
  }
  if (tasks_[0].velocity.size() >= 3) {
    tasks_[0].velocity.head<3>() += output.repulsion_m_s;
  }
  const std::size_t further = std::min<std::size_t>(input.further_tasks.size(), kMaxTasks - 1);
  std::copy_n(input.further_tasks.begin(), further, tasks_.begin() + 1);

  JointBox limits = velocity_limits(settings_.limits);
  std::size_t rows = 0;
  for (std::size_t i = 0; i < input.body.size(); ++i) {
    const BodyPoint& point = input.body[i];
    const Obstacle obstacle = complete(point.obstacle, i + 1);
    output.largest_risk = std::max(output.largest_risk, risk(obstacle, settings_.body.rho_m, settings_.body.alpha));
    const bool as_row = settings_.body.law == BodyLaw::approach_row && rows < approach_.size();
    const auto row = as_row && point.jacobian.cols() == limits.joints()
                         ? approach_limit(point.jacobian, obstacle, settings_.body)
                         : std::nullopt;
    if (row) {
      approach_[rows++] = *row;
    } else {
      limit_by_obstacle(limits, settings_.limits.velocity_rad_s, point.jacobian, obstacle, settings_.body);
    }
  }
  const bool basic = settings_.saturation.variant == SaturationVariant::basic;
  output.box = tightened(
      basic ? stoppable_velocities(settings_.limits, limiter_.last().position_rad, settings_.period_s) : limiter_.box(),
      limits);

  const SaturationResult result = saturation_.solve(std::span<const Task>(tasks_).first(further + 1), output.box,
                                                    posture_velocity(), std::span(approach_).first(rows));
  output.tasks = result.tasks;
  output.command = limiter_.step(result.velocity_rad_s);
  return output;
}

}  // namespace depthgrid::control
