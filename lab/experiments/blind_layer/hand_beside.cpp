#include "lab/experiments/blind_layer/hand_beside.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/stage/declared_rig.hpp"

namespace depthgrid::experiments {

using simulation::BodyKind;
using simulation::WorkcellBody;

namespace {

constexpr double kRho_m = 0.6;
constexpr double kHandVMax_m_s = 2.0;
const Eigen::Vector3d kAway_world(-2.8, 2.8, 0.2);  // a corner of the room, far outside of what is asked

WorkcellBody ball() {
  WorkcellBody body;
  body.name = "hand";
  body.kind = BodyKind::person;
  body.spheres = {{kAway_world, kHandRadius_m}};
  return body;
}

}  // namespace

HandBeside::HandBeside(const Rig& rig, std::uint64_t seed)
    : rig_(rig),
      cell_(simulation::empty_workcell()),
      sensors_(rig, {.seed = seed}),
      ideal_m_(rig.cameras.size()),
      measured_m_(rig.cameras.size()),
      bodies_(rig.cameras.size()) {
  cell_.bodies.push_back(simulation::capsule_body("arm", BodyKind::robot, arm_.capsules_world()));
  hand_ = cell_.bodies.size();  // NOLINT(cppcoreguidelines-prefer-member-initializer): behind the arm
  cell_.bodies.push_back(ball());
  caster_.emplace(cell_);
}

Eigen::Vector3d HandBeside::direction_world(HandPlace place) const {
  const Eigen::Vector3d middle = 0.5 * (link_world().a + link_world().b);
  // The last link of the LWR is a ball: upright will do for its axis.
  const Eigen::Vector3d along = link_world().b - link_world().a;
  const Eigen::Vector3d axis = along.norm() > 1e-6 ? Eigen::Vector3d(along.normalized()) : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d to_camera = rig_.cameras.front().T_world_camera.translation() - middle;
  const Eigen::Vector3d across = to_camera - axis.dot(to_camera) * axis;
  if (place == HandPlace::before) {
    return across.normalized();
  }
  // Of the two sides the one that is farther from the rest of the arm.
  const Eigen::Vector3d side = axis.cross(across).normalized();
  const auto free_m = [&](const Eigen::Vector3d& direction) {
    double least_m = 10;
    const auto links = arm_.capsules_world();
    for (const Capsule& link : links.first(links.size() - 1)) {
      least_m = std::min(least_m, distance_to_axis(link, middle + 0.3 * direction) - link.radius_m);
    }
    return least_m;
  };
  return free_m(side) > free_m(-side) ? side : Eigen::Vector3d(-side);
}

void HandBeside::take(HandPlace place, std::optional<double> gap_m, std::uint64_t frame) {
  const Capsule& link = link_world();
  cell_.bodies[hand_].spheres.front().centre_world =
      gap_m
          ? Eigen::Vector3d(0.5 * (link.a + link.b) + (link.radius_m + *gap_m + kHandRadius_m) * direction_world(place))
          : kAway_world;
  caster_->update(cell_);
  for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
    caster_->render(rig_.cameras[k].intrinsics, rig_.cameras[k].T_world_camera, ideal_m_[k], bodies_[k]);
  }
  sensors_.measure(ideal_m_, frame, measured_m_);
}

views::Settings hand_settings(const Rig& rig) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.2, -1.2, -0.3}, {1.2, 1.2, 1.5}};
  settings.policies = {.unobserved = views::Policy::obstacle,
                       .outside = views::Policy::ignored,
                       .robot_pockets = views::Policy::obstacle};
  settings.margins = camera_margins(rig);
  settings.rho_m = kRho_m;
  settings.v_max_m_s = 0;  // the images are of one instant
  return settings;
}

namespace {

search::EvaluatorOptions remembering(const views::Settings& settings) {
  const auto& box = std::get<views::BoxSpace>(settings.space);
  search::EvaluatorOptions options;
  options.memory =
      memory::MemorySettings{.low_world = box.low_world, .high_world = box.high_world, .start = memory::StartUnknown{}};
  return options;
}

views::Settings declared_settings(const Rig& rig) {
  views::Settings settings = hand_settings(rig);
  settings.v_max_m_s = kHandVMax_m_s;
  return settings;
}

}  // namespace

RememberedScene::RememberedScene(HandBeside& scene, double padding_m)
    : scene_(scene),
      rig_(with_declarations(scene.rig())),
      evaluator_(rig_, declared_settings(rig_), remembering(hand_settings(rig_))) {
  for (const RigCamera& camera : rig_.cameras) {
    removals_.emplace_back(camera.intrinsics, scene.arm().capsules(), robot::RemovalSettings{padding_m, true, true});
  }
}

void RememberedScene::see(HandPlace place, std::optional<double> gap_m, int images) {
  for (int image = 0; image < images; ++image, ++images_) {
    scene_.take(place, gap_m, images_);
    for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
      Frame frame{depth_view(scene_.depth_m(k)), {}, static_cast<double>(images_) / 30};
      frame.robot = removals_[k].find(scene_.arm().T_world_link(), rig_.cameras[k].T_world_camera, {}, &frame.depth);
      if (const FrameUpdate update = evaluator_.update(k, frame); !update.taken()) {
        fail("a simulated frame was not taken: ", update.reason);
      }
    }
  }
}

Answer RememberedScene::distance(const Capsule& capsule_world) { return evaluator_.distance(capsule_world); }

Answer removed_answer(const HandBeside& scene, double padding_m) {
  const Rig& rig = scene.rig();
  search::SearchEvaluator evaluator(rig, hand_settings(rig));
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const RigCamera& camera = rig.cameras[k];
    robot::RobotRemoval removal(camera.intrinsics, scene.arm().capsules(), {padding_m, true});
    Frame frame{depth_view(scene.depth_m(k)), {}, 0};
    frame.robot = removal.find(scene.arm().T_world_link(), camera.T_world_camera, {}, &frame.depth);
    if (const FrameUpdate update = evaluator.update(k, frame); !update.taken()) {
      fail("a simulated frame was not taken: ", update.reason);
    }
  }
  return evaluator.distance(scene.link_world());
}

}  // namespace depthgrid::experiments
