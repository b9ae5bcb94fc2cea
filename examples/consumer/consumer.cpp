// Loads a rig, takes one depth image and prints one distance: a program that stands on the installed package.
#include <cstdint>
#include <exception>
#include <iostream>
#include <vector>

#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/input/control_points.hpp"
#include "depthgrid/input/png.hpp"
#include "depthgrid/input/rig_file.hpp"

int main() try {
  const depthgrid::input::RigFile file = depthgrid::input::parse_rig(R"({
    "name": "cell", "depth": {"metres_per_unit": 0.001}, "cameras": [{
      "id": "front", "width": 320, "height": 240, "fx": 260.0, "fy": 260.0, "cx": 159.5, "cy": 119.5,
      "T_world_cam": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})",
                                                                     "rig in consumer.cpp");
  depthgrid::grid::GridEvaluator evaluator(file.rig, 0, {}, {});

  const std::vector<std::uint16_t> pixels(320 * 240, 2000);  // a wall at 2 m
  depthgrid::Frame frame;
  frame.depth = depthgrid::depth_view(pixels, 320, 240, file.rig.cameras[0].metres_per_unit);
  evaluator.update({&frame, 1});

  const depthgrid::input::ControlPoint point = depthgrid::input::parse_control_point("0,0,1.8", "wrist");
  const depthgrid::Proximity answer = evaluator.evaluate(point.p_m).nearest;
  std::cout << point.id << ": " << answer.distance_m << " m, " << depthgrid::to_string(answer.state) << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
