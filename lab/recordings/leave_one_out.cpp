#include "lab/recordings/leave_one_out.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::lab {

namespace {

constexpr double kReach_m = 20;

views::Settings settings_of(const std::vector<CameraMargins>& margins, double v_max_m_s) {
  views::Settings settings;
  settings.space = views::BoxSpace{Eigen::Vector3d::Constant(-kReach_m), Eigen::Vector3d::Constant(kReach_m)};
  // An ignored gap between the views would count as free although nobody reports it so.
  settings.policies.unobserved = views::Policy::obstacle;
  settings.policies.outside = views::Policy::ignored;
  settings.policies.robot_pockets = views::Policy::obstacle;
  settings.margins = margins;
  settings.rho_m = kLeaveOneOutRho_m;
  settings.resolution_m = kLeaveOneOutResolution_m;
  settings.v_max_m_s = v_max_m_s;
  return settings;
}

/// True when some camera looks at the reading's point; finds the one that frees it by most.
bool look(const views::Snapshot& snapshot, LeftOutReading& reading) {
  bool covered = false;
  double most_m = 0;
  for (std::size_t k = 0; k < snapshot.camera_count(); ++k) {
    const RigCamera& camera = snapshot.camera(k);
    const Eigen::Vector3d p_camera = snapshot.T_world_camera(k).inverse() * reading.p_world;
    if (!(p_camera.z() > camera.rule.near_m)) {
      continue;
    }
    const DepthPoint p = project(camera.intrinsics, p_camera);
    const int u = static_cast<int>(std::floor(p.x_px));
    const int v = static_cast<int>(std::floor(p.y_px));
    if (!camera.intrinsics.contains(u, v)) {
      continue;
    }
    covered = true;
    const double beyond_m = static_cast<double>(snapshot.view(k).free_m(u, v)) - p_camera.z();
    if (beyond_m > most_m) {
      most_m = beyond_m;
      reading.known_free_by = static_cast<int>(k);
      reading.known_free_u = u;
      reading.known_free_v = v;
      reading.gap_m = static_cast<double>(snapshot.view(k).measured_m(u, v)) - p_camera.z();
    }
  }
  return covered;
}

}  // namespace

double allowance_m(const CameraMargins& left_out, double v_max_m_s, double depth_m, double range_m) {
  return kLeaveOneOutResolution_m + depth_margin_m(left_out.sensor, depth_m) * range_m / depth_m +
         left_out.translation_m + left_out.rotation_rad * range_m +
         v_max_m_s * (left_out.half_exposure_s + left_out.time_uncertainty_s);
}

LeaveOneOut::LeaveOneOut(const Rig& asked, const std::vector<CameraMargins>& margins, double v_max_m_s)
    : settings_(settings_of(margins, v_max_m_s)), store_(asked, settings_) {}

void LeaveOneOut::update(std::size_t slot, const Frame& frame, const Pose& T_world_camera) {
  if (!store_.update(slot, frame, T_world_camera).taken()) {
    fail("camera ", slot, ": its frame was not taken; it must have the calibration's size");
  }
}

DepthImage LeaveOneOut::measured(std::size_t slot) const {
  const views::Snapshot snapshot = store_.snapshot();
  const views::View& view = snapshot.view(slot);
  DepthImage image(view.width_px(), view.height_px());
  for (int v = 0; v < image.height_px(); ++v) {
    for (int u = 0; u < image.width_px(); ++u) {
      image.at(u, v) = view.measured_m(u, v);
    }
  }
  return image;
}

std::vector<LeftOutReading> LeaveOneOut::check(const RigCamera& left_out, const CameraMargins& margins,
                                               const DepthImage& depth, int stride) {
  const views::Snapshot snapshot = store_.snapshot();
  const MeasurementRule& rule = left_out.rule;
  const Eigen::Vector3d centre = left_out.T_world_camera.translation();
  std::vector<LeftOutReading> readings;
  std::vector<Capsule> points;
  std::vector<Capsule> before;
  for (int v = stride / 2; v < depth.height_px(); v += stride) {
    for (int u = stride / 2; u < depth.width_px(); u += stride) {
      LeftOutReading reading;
      reading.u = u;
      reading.v = v;
      reading.depth_m = depth.at(u, v);
      // A reading clamped to far_m says that the surface is farther, not that it is there.
      if (!(reading.depth_m > 0) || static_cast<double>(reading.depth_m) >= rule.far_m) {
        continue;
      }
      const Eigen::Vector3d p_camera = deproject(left_out.intrinsics, {u + 0.5, v + 0.5, reading.depth_m});
      reading.p_world = left_out.T_world_camera * p_camera;
      if (!look(snapshot, reading)) {
        continue;
      }
      reading.allowance_m = allowance_m(margins, settings_.v_max_m_s, p_camera.z(), p_camera.norm());
      readings.push_back(reading);
      points.push_back(Capsule::point(reading.p_world));
      before.push_back(Capsule::point(reading.p_world + kProbe_m * (centre - reading.p_world).normalized()));
    }
  }
  std::vector<Answer> answers(points.size());
  std::vector<Answer> answers_before(points.size());
  search_.distances(snapshot, points, answers);
  search_.distances(snapshot, before, answers_before);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings[i].answer_m = answers[i].nearest.distance_m;
    readings[i].before_m = answers_before[i].nearest.distance_m;
    if (!std::isfinite(readings[i].answer_m)) {
      fail("a reading of ", left_out.id, " has no distance; the cameras must stand within the box of 20 m");
    }
  }
  return readings;
}

}  // namespace depthgrid::lab
