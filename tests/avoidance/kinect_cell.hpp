// The letter's cell with nobody in it: two simulated cameras and the LWR 4+, as images for the least padding.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "depthgrid/avoidance/least_padding.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::avoidance::test {

struct KinectCellOptions {
  std::string_view sensor = "kinect_v1";
  int width_px = 640;
  int images = 2;  ///< a camera: cells
  std::uint64_t seed = 1;
  bool margin_in_test = true;
  bool declared = true;  ///< the sensor's smallest obstacle and second view, and an exposure of 16 ms
};

/// Owns the pixels of its cells.
struct KinectCell {
  Rig rig;
  robot::RobotModel model = robot::kuka_lwr4();
  std::vector<DepthImage> images_m;
  std::vector<EmptyCell> cells;
  LeastPaddingSettings settings;
};

/// The arm as at the beginning of the avoidance experiments. `more`: what else stands there.
[[nodiscard]] KinectCell kinect_cell(const KinectCellOptions& options,
                                     const std::vector<simulation::WorkcellBody>& more = {});

}  // namespace depthgrid::avoidance::test
