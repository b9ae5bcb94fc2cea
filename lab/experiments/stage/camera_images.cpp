#include "lab/experiments/stage/camera_images.hpp"

#include <algorithm>

#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/stage/declared_rig.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kModelPadding = 0.02;   ///< metres
constexpr double kRobotsDistance = 2.5;  ///< farthest part of the robot from a camera, metres
constexpr double kCorner = 1.3;          ///< along a ray in the corner of the image a depth error is this much longer

double padding_for(const Rig& rig, RobotPixels robot) {
  if (robot == RobotPixels::thin_layer) {
    return thin_padding_m(rig.cameras.front().sensor);
  }
  double margin_m = 0;
  for (const RigCamera& camera : rig.cameras) {
    if (camera.margins) {
      margin_m = std::max(margin_m, depth_margin_m(camera.margins->sensor, kRobotsDistance));
    }
  }
  return kModelPadding + kCorner * margin_m;
}

bool is_ideal(const Rig& rig) {
  return std::all_of(rig.cameras.begin(), rig.cameras.end(),
                     [](const RigCamera& camera) { return camera.sensor.empty() || camera.sensor == "ideal"; });
}

}  // namespace

CameraImages::CameraImages(const Rig& rig, const StagedCell& stage, RobotPixels robot,
                           const simulation::SensorGroupSettings& noise)
    : rig_(rig),
      robot_(robot),
      padding_m_(padding_for(rig, robot)),
      caster_(stage.cell()),
      sensors_(rig, noise),
      ideal_m_(rig.cameras.size()),
      measured_m_(rig.cameras.size()),
      frames_(rig.cameras.size()) {
  const workcell::DepthCaster empty(simulation::empty_workcell());
  for (const RigCamera& camera : rig_.cameras) {
    empty.render(camera.intrinsics, camera.T_world_camera, empty_m_.emplace_back());
    removals_.emplace_back(camera.intrinsics, stage.arm().capsules(),
                           robot::RemovalSettings{padding_m_, !is_ideal(rig), robot == RobotPixels::thin_layer});
  }
}

void CameraImages::take(const StagedCell& stage, std::uint64_t frame, double time_s) {
  caster_.update(stage.cell());
  workcell::BodyImage bodies;
  for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
    const RigCamera& camera = rig_.cameras[k];
    caster_.render(camera.intrinsics, camera.T_world_camera, ideal_m_[k], bodies);
    if (robot_ == RobotPixels::background) {
      for (std::size_t i = 0; i < bodies.body.size(); ++i) {
        if (bodies.body[i] == stage.arm_body()) {
          ideal_m_[k].data()[i] = empty_m_[k].data()[i];
        }
      }
    }
  }
  sensors_.measure(ideal_m_, frame, measured_m_);
  for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
    frames_[k].depth = depth_view(measured_m_[k]);
    frames_[k].time_s = time_s;
    if (robot_ != RobotPixels::background) {
      frames_[k].robot =
          removals_[k].find(stage.arm().T_world_link(), rig_.cameras[k].T_world_camera, {}, &frames_[k].depth);
    }
  }
}

}  // namespace depthgrid::experiments
