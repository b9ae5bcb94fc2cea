#include "lab/experiments/loop/avoidance_cell.hpp"

#include <utility>

#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/stage/rig_width.hpp"

namespace depthgrid::experiments {

using simulation::BodyKind;
using simulation::WorkcellBody;

namespace {

/// The pedestal and the base touch the links that move, always: they are part of the room here.
BodyKind kind_of(const robot::RobotModel& model, std::size_t link) {
  return model.joint_of_link(link).parent ? BodyKind::robot : BodyKind::room;
}

}  // namespace

Rig avoidance_rig(int cameras, int width_px, std::string_view sensor) {
  Rig rig = simulation::arrangement(2, sensor).rig;
  rig.cameras.resize(static_cast<std::size_t>(cameras));
  return with_width(std::move(rig), width_px);
}

AvoidanceCell::AvoidanceCell(const robot::RobotModel& model, const AvoidanceMotion& motion)
    : motion_(motion), cell_(simulation::empty_workcell()) {
  cell_.bodies[simulation::body_index(cell_, "pedestal")].kind = BodyKind::room;
  for (std::size_t i = 0; i < motion.plates.size(); ++i) {
    WorkcellBody body;
    body.name = "plate " + std::to_string(i + 1);
    body.boxes = {motion.plates[i]};
    cell_.bodies.push_back(std::move(body));
  }
  first_link_body_ = cell_.bodies.size();
  for (const robot::LinkCapsule& item : robot::link_capsules(model)) {
    if (link_of_body_.empty() || link_of_body_.back() != item.link) {
      WorkcellBody body;
      body.name = model.links()[item.link].name;
      body.kind = kind_of(model, item.link);
      link_of_body_.push_back(item.link);
      cell_.bodies.push_back(std::move(body));
    }
    cell_.bodies.back().capsules.push_back({item.capsule.a, item.capsule.b, item.capsule.radius_m});
  }
  if (motion.at) {
    const MovingSolids solids = motion.at(0);
    WorkcellBody body;
    body.name = "person";
    body.kind = BodyKind::person;
    body.capsules = solids.capsules;
    body.boxes = solids.boxes;
    person_ = cell_.bodies.size();
    cell_.bodies.push_back(std::move(body));
  }
  caster_.emplace(cell_);
  truth_.emplace(cell_);
}

void AvoidanceCell::update(double time_s, std::span<const Pose> T_world_link) {
  for (std::size_t i = 0; i < link_of_body_.size(); ++i) {
    cell_.bodies[first_link_body_ + i].T_world_body = T_world_link[link_of_body_[i]];
  }
  if (person_) {
    MovingSolids solids = motion_.at(time_s);
    cell_.bodies[*person_].capsules = std::move(solids.capsules);
    cell_.bodies[*person_].boxes = std::move(solids.boxes);
  }
  truth_->update(cell_);
}

void AvoidanceCell::render(const Rig& rig, std::vector<DepthImage>& depth_m) {
  caster_->update(cell_);
  depth_m.resize(rig.cameras.size());
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    caster_->render(rig.cameras[k].intrinsics, rig.cameras[k].T_world_camera, depth_m[k]);
  }
}

std::optional<TrueDistance> AvoidanceCell::nearest(BodyKind kind) const {
  const auto found = truth_->nearest(BodyKind::robot, {kind});
  if (!found) {
    return std::nullopt;
  }
  const bool robot_first = cell_.bodies[found->first].kind == BodyKind::robot;
  const std::size_t body = robot_first ? found->first : found->second;
  return TrueDistance{found->distance_m, link_of_body_[body - first_link_body_],
                      robot_first ? found->on_first_world : found->on_second_world,
                      robot_first ? found->on_second_world : found->on_first_world};
}

std::optional<TrueDistance> AvoidanceCell::to_person() const { return nearest(BodyKind::person); }
std::optional<TrueDistance> AvoidanceCell::to_objects() const { return nearest(BodyKind::object); }

}  // namespace depthgrid::experiments
