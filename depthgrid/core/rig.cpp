#include "depthgrid/core/rig.hpp"

#include <cmath>
#include <set>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/sensor_models.hpp"

namespace depthgrid {
namespace {

void check_pose(const Pose& pose, const std::string& name) {
  pose_from_matrix(pose.matrix(), name.c_str());
  const double largest = pose.translation().cwiseAbs().maxCoeff();
  if (!(largest <= kLargestTranslation)) {
    fail(name, ": translation reaches ", largest, " m, must be at most ", kLargestTranslation,
         "; move the world's origin near the cameras");
  }
}

void check_sensor(const RigCamera& camera, const std::string& name) {
  try {
    (void)sensor_model(camera.sensor);
  } catch (const Error& error) {
    fail(name, ": ", error.what());
  }
  if (!camera.margins) {
    fail(name, ": has the sensor model '", camera.sensor, "' but no margins; take those of sensor_margins()");
  }
}

}  // namespace

void validate(const Rig& rig) {
  if (rig.cameras.empty()) {
    fail("rig '", rig.name, "': has no camera, needs at least one");
  }
  if (rig.T_floor_world) {
    check_pose(*rig.T_floor_world, "rig '" + rig.name + "': T_floor_world");
  }
  std::set<std::string> ids;
  for (const RigCamera& camera : rig.cameras) {
    if (camera.id.empty()) {
      fail("rig '", rig.name, "': a camera has an empty id");
    }
    if (!ids.insert(camera.id).second) {
      fail("rig '", rig.name, "': camera id '", camera.id, "' occurs twice, ids must be distinct");
    }
    const std::string name = "camera '" + camera.id + "'";
    validate(camera.intrinsics, name.c_str());
    validate(camera.rule, name.c_str());
    check_plausible_scale(camera.metres_per_unit, name.c_str());
    check_pose(camera.T_world_camera, name + ": T_world_camera");
    if (camera.margins) {
      validate(*camera.margins, name.c_str());
    }
    if (!camera.sensor.empty()) {
      check_sensor(camera, name);
    }
  }
}

Rig checked_rig(Rig rig, const char* reader) {
  validate(rig);
  for (RigCamera& camera : rig.cameras) {
    if (distorts(camera.distortion)) {
      fail(reader, ": camera '", camera.id,
           "' has lens distortion, its images must be undistorted first and the rig given without distortion");
    }
    camera.T_world_camera = pose_from_matrix(camera.T_world_camera.matrix());
  }
  return rig;
}

std::vector<CameraMargins> camera_margins(const Rig& rig) {
  std::vector<CameraMargins> margins;
  for (const RigCamera& camera : rig.cameras) {
    if (!camera.margins) {
      fail("rig '", rig.name, "': camera '", camera.id,
           "' has no margins, so nothing is known of its errors; give its sensor (\"ideal\": none) or margins");
    }
    margins.push_back(*camera.margins);
  }
  return margins;
}

std::size_t camera_index(const Rig& rig, const std::string& id) {
  std::string known;
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    if (rig.cameras[k].id == id) {
      return k;
    }
    known += (k == 0 ? "" : ", ") + rig.cameras[k].id;
  }
  fail("rig '", rig.name, "': there is no camera '", id, "', its cameras are ", known);
}

}  // namespace depthgrid
