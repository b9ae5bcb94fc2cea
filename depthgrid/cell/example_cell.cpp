#include <sstream>

#include "depthgrid/cell/cell_file.hpp"

namespace depthgrid::cell {
namespace {

std::string entry_of(const ExampleCamera& camera) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(3);
  text << "  - name: " << camera.name << "  # " << camera.comment << "\n    source: " << camera.source << '\n';
  if (!camera.serial.empty()) {
    text << "    serial: \"" << camera.serial << "\"\n";
  }
  if (camera.intrinsics) {
    const PinholeCamera& image = *camera.intrinsics;
    const Eigen::Vector2d centre = principal_point_opencv(image);
    text << (camera.is_calibrated ? "    intrinsics" : "    # intrinsics") << ": {width_px: " << image.width_px
         << ", height_px: " << image.height_px << ", fx_px: " << image.fx_px << ", fy_px: " << image.fy_px
         << ", cx_px: " << centre.x() << ", cy_px: " << centre.y() << "}"
         << (camera.is_calibrated ? "   # the camera's own\n"
                                  : "   # usual ones of such a camera, not yours: calibrate it\n");
  } else {
    text << "    # intrinsics: {width_px: 640, height_px: 480, fx_px: , fy_px: , cx_px: , cy_px: }   # it says none\n";
  }
  if (camera.metres_per_unit != 0.001) {
    std::ostringstream unit;
    unit << camera.metres_per_unit;
    text << "    metres_per_unit: " << unit.str() << '\n';
  }
  // Nobody knows where it stands. What looks like a pose would be answered with.
  text << "    # measure where it stands: until numbers are here, check and run refuse this file\n"
          "    pose: {position_m: [measure, measure, measure], look_at_m: [measure, measure, measure]}"
          "   # of the depth imager, in the world\n";
  text << (camera.sensor.empty() ? "    # sensor: which of docs/sensor-models.md, or margins: {constant_m, ...}\n"
                                 : "    sensor: " + camera.sensor + "\n");
  // How well the time of an image is known: docs/cameras.md.
  text << "    margins: {translation_m: measure, rotation_deg: measure"
       << (camera.source == "realsense" ? ", time_uncertainty_s: 0.005" : ", time_uncertainty_s: 0.1")
       << "}   # how well the pose is known\n";
  return text.str();
}

}  // namespace

std::string example_cell(std::span<const ExampleCamera> cameras) {
  constexpr std::string_view kBegin = "\ncameras:\n";
  constexpr std::string_view kEnd = "\nrobot:\n";
  std::string text(example_cell());
  if (cameras.empty()) {
    return text;
  }
  std::string entries;
  for (const ExampleCamera& camera : cameras) {
    entries += entry_of(camera);
  }
  constexpr std::string_view kWhat = "two RealSense D435 and a Franka Panda";
  text.replace(text.find(kWhat), kWhat.size(), "the cameras that were found, and a Franka Panda");
  const std::size_t begin = text.find(kBegin) + kBegin.size();
  return text.replace(begin, text.find(kEnd) - begin, entries);
}

std::string_view example_cell() noexcept {
  return R"(# A robot cell for depthgrid: two RealSense D435 and a Franka Panda. Every number here is yours to check.
# Lengths in metres, times in seconds, angles in degrees, as the names say. Paths are relative to this file.
#   depthgrid cell check FILE    what is missing or implausible, and what each camera sees
#   depthgrid run FILE           distances, until Ctrl-C

name: panda cell

# Nothing in the cell is smaller than this, so that small holes in the images count as what surrounds them.
# 0 says nothing: every pixel without a reading may hide something.
smallest_obstacle_m: 0.02

cameras:
  - name: left
    source: ros2                 # or recording, simulated
    topic: /left/depth/image_rect_raw   # of the camera's ROS 2 node, realsense2_camera for instance
    intrinsics: {width_px: 640, height_px: 480, fx_px: 385.0, fy_px: 385.0, cx_px: 319.5, cy_px: 239.5}
    pose: {position_m: [1.8, 1.2, 1.4], look_at_m: [0, 0, 0.5]}   # of the depth imager, in the world
    sensor: realsense_d435       # its noise, range and exposure
    margins: {translation_m: 0.005, rotation_deg: 0.15}           # how well the pose is known
  - name: right
    source: ros2
    topic: /right/depth/image_rect_raw
    intrinsics: {width_px: 640, height_px: 480, fx_px: 385.0, fy_px: 385.0, cx_px: 319.5, cy_px: 239.5}
    pose: {position_m: [1.8, -1.2, 1.4], look_at_m: [0, 0, 0.5]}
    sensor: realsense_d435
    margins: {translation_m: 0.005, rotation_deg: 0.15}

robot:
  urdf: panda.urdf
  base: {position_m: [0, 0, 0]}                      # of its root link, in the world; rpy_deg: [0, 0, 90] turns it
  joints: {source: ros2, topic: /joint_states, time_error_s: 0.02}
  padding_m: 0.10                # what is nearer to the robot than this is not seen: depthgrid run says how thick it is
  tool: panda_hand

# Where obstacles count: a box in the world.
space: {low_m: [-1.2, -1.2, 0.02], high_m: [1.2, 1.2, 1.6]}

# What counts as an obstacle. None of this has a default.
policies:
  unobserved: obstacle           # space that no camera looks at
  outside: ignored               # space outside of the box; answers say how far they know
  robot_pockets: obstacle        # the shadow right behind the robot; ignored needs ignored_pocket_m, and no memory
v_max_m_s: 1.6                   # nothing moves faster: a person who walks
memory: {start: unknown}         # what was seen free stays free until something could have come there; or none

ask:
  rate_hz: 500
  links: moving                  # every link that at least two joints move; or a list of names
  rho_m: 0.6                     # how far around them obstacles matter
  stop_m: 0.10                   # a link that is not farther than this beyond its blind layer says stop

ages: {image_s: 0.2, joints_s: 0.05}   # older images free nothing; older joints: no answer

outputs:
  udp: {host: 127.0.0.1, port: 47000}  # a datagram an answer: depthgrid/network/datagram.h
  ros2: true                           # distances, markers for rviz2, diagnostics: docs/ros2.md
  terminal: true
)";
}

}  // namespace depthgrid::cell
