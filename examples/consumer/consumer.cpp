// Loads a rig, takes one depth image and prints one distance: a program that stands on the installed package.
#include <cstdint>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <vector>

#include "depthgrid/files/control_points.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/search/search_evaluator.hpp"

namespace views = depthgrid::views;

int main() try {
  const depthgrid::files::RigFile file = depthgrid::files::parse_rig(R"({
    "name": "cell", "depth": {"metres_per_unit": 0.001}, "cameras": [{
      "id": "front", "width": 320, "height": 240, "fx": 260.0, "fy": 260.0, "cx": 159.5, "cy": 119.5,
      "sensor": "ideal", "margins": {"smallest_obstacle_m": 0},
      "T_world_cam": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})",
                                                                     "rig in consumer.cpp");
  views::Settings settings;
  settings.space = views::BoxSpace{{-0.5, -0.5, 0.5}, {0.5, 0.5, 2.5}};
  settings.policies.unobserved = views::Policy::obstacle;
  settings.policies.outside = views::Policy::ignored;
  settings.policies.robot_pockets = views::Policy::obstacle;
  settings.margins = depthgrid::camera_margins(file.rig);
  settings.v_max_m_s = 2.0;
  depthgrid::search::SearchEvaluator cell(file.rig, settings);

  const std::vector<std::uint16_t> pixels(320 * 240, 2000);  // a wall at 2 m
  depthgrid::Frame frame;
  frame.depth = depthgrid::depth_view(pixels, 320, 240, file.rig.cameras[0].metres_per_unit);
  if (const depthgrid::FrameUpdate update = cell.update(0, frame); !update.taken()) {
    throw std::runtime_error(update.reason);
  }

  const depthgrid::files::ControlPoint point = depthgrid::files::parse_control_point("0,0,1.8", "wrist");
  const depthgrid::Answer answer = cell.distance(point.capsule);
  std::cout << point.id << ": " << answer.nearest.distance_m << " m, " << depthgrid::to_string(answer.nearest.state)
            << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
