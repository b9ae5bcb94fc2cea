// Quick start of the search with one thread: one camera that looks at a wall 2 m away, and a link of the robot before
// it.
//
//   c++ -std=c++20 -O2 evaluator_quickstart.cpp $(pkg-config --cflags --libs depthgrid_search)
//
// or with CMake: find_package(depthgrid 0.1 REQUIRED COMPONENTS search).
//
// It prints 0.22 m for a wall that is 0.35 m away: 93 mm are how far such a camera may read too far at 2 m, 33 mm how
// far an obstacle moves within half an exposure. These are assumptions, stated by you or by a sensor model
// (docs/sensor-models.md), and nothing is subtracted beyond them but the rounding; the rest is the resolution, 5 mm.
// The 93 mm belong to this focal length, 390 px, about a D435's at 640 x 480: take your camera's own.
//
// - The world is the camera's frame, since T_world_camera is left out. Set it, and translation_m and rotation_rad of
//   the margins: here the calibration counts as exact.
// - The link stands in no image here. Where a camera sees the robot give Frame::robot, or every link in view is its own
//   obstacle, at distance 0 (docs/robot.md).
// - An answer without a distance holds NaN, so stop at !(distance >= stop), never at distance < stop.
// - Distances end at rho, 0.4 m unless settings.rho_m says otherwise: beyond_rho means that nothing is nearer.
#include <iostream>

#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/search/search_evaluator.hpp"
using namespace depthgrid;
int main() {
  const std::vector<std::uint16_t> pixels(640 * 480, 2000);  // your buffer: millimetres
  const SensorModel& d435 = sensor_model("realsense_d435");  // readings beyond 0.28 ... 3 m are none
  RigCamera camera{.id = "front", .intrinsics = from_opencv(640, 480, 390.0, 390.0, 319.5, 239.5), .rule = d435.rule};
  camera.margins = sensor_margins(d435, camera.intrinsics, camera.metres_per_unit);
  camera.margins->smallest_obstacle_m = d435.smallest_obstacle_m;  // yours to say: what is smaller may be missed
  const Rig rig{.name = "cell", .cameras = {camera}};
  const views::Settings settings{.space = views::BoxSpace{{-1, -1, 0.5}, {1, 1, 3}},
                                 .policies = {.unobserved = views::Policy::obstacle,
                                              .outside = views::Policy::ignored,
                                              .robot_pockets = views::Policy::obstacle},
                                 .margins = camera_margins(rig),
                                 .v_max_m_s = 2.0};  // of obstacles
  search::SearchEvaluator cell(rig, settings);
  const FrameUpdate update = cell.update(0, {depth_view(pixels, 640, 480, 0.001), {}, 0.0});  // with every image
  if (!update.taken()) std::cerr << update.reason << '\n';
  const Answer answer = cell.distance({{0, 0, 1.2}, {0, 0, 1.6}, 0.05});  // of a link, a capsule
  std::cout << answer.nearest.distance_m << " m, " << to_string(answer.nearest.state) << '\n';
}
