#include "lab/experiments/stage/staged_cell.hpp"

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/arrangement.hpp"

namespace depthgrid::experiments {

using simulation::BodyKind;

simulation::PersonStage stage_around_the_wrist() {
  simulation::PersonStage stage;
  stage.robot_world = {0, -0.15, 0.65};
  return stage;
}

StagedCell::StagedCell(simulation::Motion motion, const simulation::PersonStage& stage, std::uint64_t seed)
    : person_(motion, stage, seed), cell_(simulation::empty_workcell()) {
  const simulation::PersonState state = person_.at(0);
  if (state.carried_world) {
    fail("motion ", simulation::to_string(motion), " carries a box, which this cell has not");
  }
  arm_body_ = cell_.bodies.size();
  cell_.bodies.push_back(simulation::capsule_body("arm", BodyKind::robot, arm_.capsules_world()));
  person_body_ = cell_.bodies.size();
  cell_.bodies.push_back(simulation::capsule_body("person", BodyKind::person, state.parts_world));
}

void StagedCell::move_to(double time_s) {
  arm_.move_to(time_s);
  take_arm();
  move_person_to(time_s);
}

void StagedCell::send_person_away() {
  nobody_ = true;
  constexpr double kFar_m = 100;  // below the floor
  for (Capsule& part : cell_.bodies[person_body_].capsules) {
    part.a.z() -= kFar_m;
    part.b.z() -= kFar_m;
  }
}

void StagedCell::move_person_to(double time_s) {
  if (nobody_) {
    return;
  }
  const simulation::PersonState state = person_.at(time_s);
  cell_.bodies[person_body_].capsules.assign(state.parts_world.begin(), state.parts_world.end());
}

void StagedCell::take_arm() {
  cell_.bodies[arm_body_].capsules.assign(arm_.capsules_world().begin(), arm_.capsules_world().end());
}

}  // namespace depthgrid::experiments
