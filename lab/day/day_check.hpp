// What a running cell answered while its devices failed, held against what was planned and what is true.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/sensors/simulated_cell.hpp"
#include "lab/day/fault_plan.hpp"
#include "lab/measure/json_file.hpp"
#include "lab/measure/samples.hpp"

namespace depthgrid::lab {

/// What became of the faults of one kind, of cameras or of joints. Seconds.
struct FaultRow {
  std::string of;  ///< "camera", "joints"
  DeviceFault fault = DeviceFault::drop;
  std::size_t count = 0;
  Samples noticed_s;    ///< from its beginning until answers say so; of faults that have to be told
  Samples missed_s;     ///< from its end to the exposure of the first message that is used again, periods of the device
  Samples recovered_s;  ///< from its end to the first answer that stands on a message after it
  std::size_t never_recovered = 0;
};

struct DayReport {
  double seconds = 0;
  std::uint64_t answers = 0;
  std::uint64_t compared = 0;  ///< parts held against the truth
  std::uint64_t unclaimed = 0;
  std::uint64_t over_estimates = 0;
  double largest_excess_m = 0;
  Samples margin_m;         ///< truth less answer, of some parts with an obstacle within rho
  std::uint64_t blind = 0;  ///< answers of moments that had to be stopped
  std::uint64_t not_stopped = 0;
  std::uint64_t hidden_used = 0;  ///< answers that stand on a message which a fault had made one that does not count
  std::uint64_t not_told = 0;     ///< answers that do not name a camera's fault when they have to
  std::uint64_t stopped = 0;
  double longest_gap_s = 0;  ///< between two answers
  Samples latency_s;         ///< from the newest exposure to the first answer on it
  std::vector<FaultRow> rows;
  std::size_t never_recovered = 0;
  double memory_mb = 0;           ///< of the process, at the end
  double memory_growth_mb = 0;    ///< from the second quarter of the time to the last, medians
  double memory_mb_per_hour = 0;  ///< by a line through the last three quarters
  bool has_memory = false;
  std::vector<std::string> findings;  ///< the first ones, a line each

  /// One line a failed rule; empty: all held.
  [[nodiscard]] std::vector<std::string> failures() const;
};

struct DayInput {
  const cell::Cell& cell;
  const cell::CellSetup& setup;
  DayPlan plan;
  int truth_every = 1;  ///< of the answers, those that are held against the truth
};

/// `answers`: the JSON lines of depthgrid run; a last line without its end is passed over. `memory`: lines "SECONDS
/// KIB". Throws Error that names the line which is none.
[[nodiscard]] DayReport check_day(const DayInput& input, std::istream& answers, std::istream& memory);

[[nodiscard]] Json to_json(const DayReport& report);
/// The table of the page.
[[nodiscard]] std::string to_markdown(const DayReport& report);

}  // namespace depthgrid::lab
