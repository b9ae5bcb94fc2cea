#include "lab/day/day_cell.hpp"

#include <array>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "report/number_text.hpp"

namespace depthgrid::lab {

std::string day_cell(const DayCell& cell) {
  struct Place {
    std::string_view name;
    std::string_view at;
  };
  constexpr std::array<Place, 8> kPlaces{{{"front", "[2.3, -1.6, 1.4]"},
                                          {"back", "[-2.3, -1.5, 1.4]"},
                                          {"side", "[0.2, -2.6, 1.8]"},
                                          {"high", "[0.3, -1.2, 2.6]"},
                                          {"right", "[2.6, 0.2, 1.5]"},
                                          {"left", "[-2.6, 0.3, 1.6]"},
                                          {"corner", "[2.2, 2.0, 1.6]"},
                                          {"window", "[-2.1, 2.1, 1.5]"}}};
  if (cell.cameras < 1 || cell.cameras > static_cast<int>(kPlaces.size())) {
    fail(cell.cameras, " cameras, must be 1 to ", kPlaces.size());
  }
  const double focal_px = 0.78 * cell.width_px;
  std::string text = "name: a day in the life\nsmallest_obstacle_m: 0\ncameras:\n";
  for (std::size_t k = 0; k < static_cast<std::size_t>(cell.cameras); ++k) {
    const std::string name(kPlaces.at(k).name);
    text += "  - name: " + name + "\n    source: ros2\n    topic: /" + name + "/depth/image_rect_raw\n" +
            "    intrinsics: {width_px: " + std::to_string(cell.width_px) +
            ", height_px: " + std::to_string(cell.height_px) + ", fx_px: " + report::fixed(focal_px, 2) +
            ", fy_px: " + report::fixed(focal_px, 2) + ", cx_px: " + report::fixed(0.5 * cell.width_px - 0.5, 1) +
            ", cy_px: " + report::fixed(0.5 * cell.height_px - 0.5, 1) +
            "}\n    pose: {position_m: " + std::string(kPlaces.at(k).at) +
            ", look_at_m: [0, -0.1, 0.4]}\n    sensor: " + cell.sensor + "\n    equal_images: false\n" +
            (cell.time_error_s > 0 ? "    margins: {time_uncertainty_s: " + report::fixed(cell.time_error_s, 6) + "}\n"
                                   : "");
  }
  constexpr double kJoints_s = 0.001;  // and what the joints' clock is off by
  text += R"(robot:
  urdf: kuka_lwr4
  base: {position_m: [0, 0, 0]}
  joints: {source: ros2, topic: /joint_states, time_error_s: )" +
          report::fixed(kJoints_s + cell.time_error_s, 6) + R"(}
  joint_acceleration_deg_s2: 600
  padding_m: )" +
          std::string(cell.sensor == "ideal" ? "0.02" : "0.1") + R"(
  tool: lwr_7_link
space: {low_m: [-1.4, -1.4, -0.4], high_m: [1.4, 1.4, 1.4]}
policies: {unobserved: obstacle, outside: ignored, robot_pockets: ignored, ignored_pocket_m: 0.10}
v_max_m_s: 1.6
memory: none
ask: {rate_hz: )" +
          report::fixed(cell.rate_hz, 1) + R"(, links: moving, rho_m: 0.6, resolution_m: 0.01, stop_m: 0.05}
ages: {image_s: 0.3, joints_s: 0.05}
ros2: {node: depthgrid, domain: )" +
          std::to_string(cell.domain) + "}\noutputs: {terminal: false";
  text += cell.port > 0 ? ", udp: {host: 127.0.0.1, port: " + std::to_string(cell.port) + "}" : "";
  text += cell.answers.empty() ? "" : ", jsonl: " + cell.answers;
  return text + "}\n";
}

}  // namespace depthgrid::lab
