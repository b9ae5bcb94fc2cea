// A cell file in place of a recording or a robot's file, and of the options that say the same.
#pragma once

#include <functional>
#include <string>

#include "depthgrid/cell/cell.hpp"
#include "program/distances/distances_plan.hpp"

namespace CLI {
class App;
}

namespace depthgrid::program {

/// By its name: .yaml or .yml.
[[nodiscard]] bool is_cell_file(const std::string& path);

/// The cell's recording, which all its cameras are of, the ids of its cameras, and topics of an MCAP file. Throws
/// UsageError where a camera has another source or another recording, or states what only `depthgrid run` knows.
struct CellRecordingChoice {
  std::string recording;
  std::vector<std::string> cameras;
  std::vector<std::string> topics;
};
[[nodiscard]] CellRecordingChoice recording_of(const cell::Cell& cell);

/// Where options.recording is a cell file: everything that it says, as options, but for those that `command` was given,
/// which are told on standard error. Throws Error as load_cell(), and UsageError where the cell says what no option of
/// `distances` says.
void take_cell_file(const CLI::App& command, DistancesOptions& options);

}  // namespace depthgrid::program
