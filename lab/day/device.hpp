// A device of the simulated cell as other nodes see it: topics of ROS 2, from a node of its own.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/sensors/simulated_cell.hpp"
#include "lab/day/fault_plan.hpp"

namespace depthgrid::lab {

struct DeviceSettings {
  DayPlan plan{};               ///< of whose faults a device takes its own
  double clock_ahead_s = 0;     ///< by which the devices' clock is ahead of this computer's
  int rendered_ahead = 0;       ///< above 0: so many images are rendered ahead and sent in turn, whatever the cell does
  std::filesystem::path log{};  ///< JSON lines: what was sent with which fault; empty: none
};

/// Sends a camera's images and its calibration, or the joints' states, until the time is over or `is_over`. Joints are
/// device kJointsDevice. Throws Error.
void run_device(const std::string& device, const cell::Cell& cell, const cell::CellSetup& setup,
                const std::shared_ptr<const sensors::SimulatedCell>& simulated, const DeviceSettings& settings,
                const std::atomic<bool>& is_over);

}  // namespace depthgrid::lab
