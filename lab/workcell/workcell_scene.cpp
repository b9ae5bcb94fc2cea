#include "lab/workcell/workcell_scene.hpp"

#include <cmath>
#include <string>

#include "depthgrid/simulation/arrangement.hpp"

namespace depthgrid::lab {

using simulation::Arm;
using simulation::BodyKind;
using simulation::PersonState;
using simulation::Workcell;
using simulation::WorkcellBody;

namespace {

/// Where a capsule lies, seen from one of its length along z that begins at the origin.
Pose pose_of(const Capsule& capsule) {
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), capsule.b - capsule.a).toRotationMatrix();
  pose.translation() = capsule.a;
  return pose;
}

}  // namespace

simulation::PersonStage WorkcellScene::stage() {
  simulation::PersonStage stage;
  stage.robot_world = {0, 0.15, 0.65};
  return stage;
}

Arm WorkcellScene::arm_at(double time_s) noexcept {
  const double a = std::sin(0.7 * time_s);
  const double b = std::sin(1.1 * time_s);
  return simulation::arm(Pose::Identity(), {1.4 + 0.6 * a, -0.5 + 0.3 * b, 0, 1.2 + 0.4 * a, 0, -0.6, 0});
}

WorkcellScene::WorkcellScene(simulation::Motion motion, std::uint64_t seed, ArmShape shape, int mesh_segments)
    : person_(motion, stage(), seed), cell_(simulation::empty_workcell()) {
  const Arm arm = arm_at(0);
  for (const Capsule& link : arm.links) {
    WorkcellBody body;
    body.name = "link " + std::to_string(link_bodies_.size() + 1);
    body.kind = BodyKind::robot;
    const Capsule upright{Eigen::Vector3d::Zero(), {0, 0, (link.b - link.a).norm()}, link.radius_m};
    if (shape == ArmShape::meshes) {
      body.mesh = std::make_shared<simulation::TriangleMesh>(simulation::mesh_of(upright, mesh_segments));
    } else {
      body.capsules = {upright};
    }
    link_bodies_.push_back(cell_.bodies.size());
    cell_.bodies.push_back(std::move(body));
  }
  // NOLINTNEXTLINE(cppcoreguidelines-prefer-member-initializer): known only after the links
  person_body_ = cell_.bodies.size();
  const PersonState state = person_.at(0);
  cell_.bodies.push_back(simulation::capsule_body("person", BodyKind::person, state.parts_world));
  if (state.carried_world) {
    box_body_ = cell_.bodies.size();
    WorkcellBody box;
    box.name = "carried box";
    box.boxes = {*state.carried_world};
    cell_.bodies.push_back(std::move(box));
  }
}

const Workcell& WorkcellScene::at(double time_s) {
  const Arm arm = arm_at(time_s);
  for (std::size_t i = 0; i < link_bodies_.size(); ++i) {
    cell_.bodies[link_bodies_[i]].T_world_body = pose_of(arm.links[i]);
  }
  const PersonState state = person_.at(time_s);
  cell_.bodies[person_body_].capsules.assign(state.parts_world.begin(), state.parts_world.end());
  if (box_body_) {
    cell_.bodies[*box_body_].boxes = {*state.carried_world};
  }
  return cell_;
}

}  // namespace depthgrid::lab
