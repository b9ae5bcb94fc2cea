// The log of a running cell: a line for each stop and go, with the terms that separation monitoring sums up.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/monitor/event.hpp"

namespace depthgrid::monitor {

/// What of the cell a line needs beside the event.
struct StopLogSettings {
  Names names{};
  Rig rig{};
  std::vector<bool> moves{};           ///< cameras that /tf places: where they were is not in the rig; empty: none
  std::optional<double> stopping_s{};  ///< what the robot takes to stand still, as the cell's file declares it
};

/// Of a stop or a go, without an end of line:
/// "2026-11-30T21:23:06.123Z stop: SENTENCE | distance 0.131 m (0.147 m at the images' time); human at most 1.6 m/s;
/// reaction 0.01 s; stopping 0.3 s; robot 0.42 m/s, moved 0.004 m since its joint state; sensor 0.012 m; stops at 0.143
/// m: blind layer 0.093 m + limit 0.05 m". The time is this computer's time of day. What is not known is "?".
[[nodiscard]] std::string stop_log_line(const Event& event, const StopLogSettings& settings);

}  // namespace depthgrid::monitor
