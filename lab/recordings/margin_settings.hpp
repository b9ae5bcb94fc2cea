// The margins under which the search is run on the recordings: none, the sensor's, and those of calibration and time.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::lab {

/// One choice of margins for all cameras of a rig.
struct MarginSetting {
  std::string name;
  std::vector<CameraMargins> margins;  ///< in the rig's order
  double v_max_m_s = 0;
};

/// kinect3_ball: none with w = 0 and w = 1, Kinect v1, Kinect v1 with calibration, and with calibration and time. The
/// calibration errors are what a floor fitted in each camera alone deviates by from the one fitted in all: cam1 21 mm
/// and 0.84 degrees, cam2 10 mm and 0.38, cam3 13 mm and 0.33. Time: half the sensor's exposure, a quarter of a frame
/// at 30 Hz for the stamp (the tracks of the ball exclude more), and 1.6 m/s, the speed of walking. Cameras as in the
/// rig.
[[nodiscard]] std::vector<MarginSetting> ball_margins(const Rig& rig);

/// redkitchen_poses: the same without time, since nothing moves there but the camera, whose images are exact in time
/// then. The pose error is judged: 15 mm, the largest median distance between surfaces in the recording's own check,
/// and 0.5 degrees.
[[nodiscard]] std::vector<MarginSetting> kitchen_margins(std::size_t camera_count);

/// The cameras with the range in which the Kinect v1's model believes readings.
[[nodiscard]] Rig with_kinect_range(Rig rig);

}  // namespace depthgrid::lab
