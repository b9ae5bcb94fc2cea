#include "depthgrid/sensors/simulated_cell.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/simulation/arrangement.hpp"

namespace depthgrid::sensors {
namespace {

using simulation::BodyKind;

/// Over the free side of the room, away from the table, for an arm of the LWR's joints.
constexpr std::array<double, 7> kCentre{-1.4, -0.5, 0, 1.2, 0, -0.6, 0};
constexpr std::array<double, 7> kSwing{0.6, 0.3, 0, 0.4, 0, 0, 0};
constexpr double kSlow_rad_s = 0.7;
constexpr double kFast_rad_s = 1.1;

simulation::PersonStage stage_at_the_wrist() {
  simulation::PersonStage stage;
  stage.robot_world = {0, -0.15, 0.65};
  stage.v_max_m_s = 1.6;
  return stage;
}

}  // namespace

SimulatedCell::SimulatedCell(const SimulatedCellSettings& settings)
    : robot_(settings.robot), room_(simulation::empty_workcell()), begin_s_(settings.begin_s.value_or(clock_now_s())) {
  if (robot_) {
    capsules_ = robot::link_capsules(robot_->model);
    const auto& joints = robot_->model.joints();
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const double low = std::max(joints[i].lower, -3.0);
      const double high = std::min(joints[i].upper, 3.0);
      const bool alike = joints.size() == kCentre.size();
      centre_.push_back(std::clamp(alike ? kCentre.at(i) : 0.0, low, high));
      swing_.push_back(std::min({alike ? kSwing.at(i) : 0.2, high - centre_[i], centre_[i] - low}));
    }
  }
  if (settings.person) {
    person_.emplace(simulation::Motion::walk_in, stage_at_the_wrist(), settings.seed);
  }
}

void SimulatedCell::joints_at(double time_s, std::span<double> q) const noexcept {
  for (std::size_t i = 0; i < std::min(q.size(), centre_.size()); ++i) {
    q[i] = centre_[i] + swing_[i] * std::sin((i % 2 == 0 ? kSlow_rad_s : kFast_rad_s) * time_s);
  }
}

simulation::Workcell SimulatedCell::bodies_at(double time_s) const {
  simulation::Workcell cell = room_;
  if (robot_) {
    std::vector<double> q(centre_.size());
    joints_at(time_s, q);
    std::vector<Capsule> arm(capsules_.size());
    robot::place(capsules_, robot_->link_poses(q), arm);
    cell.bodies.push_back(simulation::capsule_body("arm", BodyKind::robot, arm));
  }
  if (person_) {
    // There and back, so that nobody jumps.
    const double way_s = person_->duration_s();
    const double at_s = std::fmod(std::max(time_s, 0.0), 2 * way_s);
    const simulation::PersonState person = person_->at(at_s < way_s ? at_s : 2 * way_s - at_s);
    cell.bodies.push_back(simulation::capsule_body("person", BodyKind::person, person.parts_world));
  }
  return cell;
}

simulation::Scene SimulatedCell::scene_at(double time_s) const { return simulation::scene_of(bodies_at(time_s)); }

}  // namespace depthgrid::sensors
