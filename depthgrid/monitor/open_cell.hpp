// From a cell's description to one that runs: its sources and its outputs.
#pragma once

#include <memory>
#include <vector>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/dds/node.hpp"
#include "depthgrid/monitor/monitor.hpp"
#include "depthgrid/network/datagram.h"

namespace depthgrid::monitor {

/// The node of ROS 2 that a cell's sources and outputs share; null where none of them is of ROS 2. Throws Error.
[[nodiscard]] std::shared_ptr<dds::Node> ros2_node(const cell::Cell& cell);

/// The sources of a cell, none of them open. The simulated ones show one cell, those of recordings keep together; those
/// of ROS 2 are topics of ros2_node().
/// Throws Error that names the place in the cell file: a source that this build has not, a recording without times.
[[nodiscard]] Sources make_sources(const cell::Cell& cell, const cell::CellSetup& setup,
                                   const std::shared_ptr<dds::Node>& ros2);

[[nodiscard]] MonitorSettings monitor_settings(const cell::Cell& cell);

/// An answer as the fields of depthgrid/network/datagram.h; of parts the first 32.
[[nodiscard]] depthgrid_answer datagram_answer(const CellAnswer& answer) noexcept;

/// Distances, markers, diagnostics and frames as topics. Throws Error, where the robot's file cannot be read, too.
[[nodiscard]] std::unique_ptr<Output> ros2_output(const cell::Cell& cell, const cell::CellSetup& setup,
                                                  const Names& names, std::shared_ptr<dds::Node> ros2);

/// Makes the file of cell.outputs.record; `{time}` in its name becomes the time of day in UTC, 20261130T212306Z. Throws
/// Error as Recorder does, and where the robot's file cannot be read.
[[nodiscard]] std::unique_ptr<Recorder> recorder(const cell::Cell& cell, const cell::CellSetup& setup,
                                                 const Names& names);

/// A datagram an answer. Throws Error.
[[nodiscard]] std::unique_ptr<Output> udp_output(const cell::UdpEntry& to);

}  // namespace depthgrid::monitor
