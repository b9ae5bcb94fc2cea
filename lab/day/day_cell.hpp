// The cell file of a day: the simulated arm and person, cameras and joints as topics of ROS 2.
#pragma once

#include <string>

namespace depthgrid::lab {

struct DayCell {
  int cameras = 3;  ///< 1 to 8
  int width_px = 160;
  int height_px = 144;
  std::string sensor = "ideal";
  double rate_hz = 100;  ///< of the questions
  int domain = 0;
  int port = 0;             ///< of the datagrams, to this computer; 0: none
  std::string answers{};    ///< JSON lines; empty: none
  double time_error_s = 0;  ///< between the devices' clocks and the asking one, at most
};

[[nodiscard]] std::string day_cell(const DayCell& cell);

}  // namespace depthgrid::lab
