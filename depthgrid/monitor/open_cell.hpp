// From a cell's description to one that runs: its sources and its outputs.
#pragma once

#include <memory>
#include <vector>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/monitor/monitor.hpp"
#include "depthgrid/network/datagram.h"

namespace depthgrid::monitor {

/// The sources of a cell, none of them open. The simulated ones show one cell, those of recordings keep together.
/// Throws Error that names the place in the cell file: a source that this build has not, a recording without times.
[[nodiscard]] Sources make_sources(const cell::Cell& cell, const cell::CellSetup& setup);

[[nodiscard]] MonitorSettings monitor_settings(const cell::Cell& cell);

/// An answer as the fields of depthgrid/network/datagram.h; of parts the first 32.
[[nodiscard]] depthgrid_answer datagram_answer(const CellAnswer& answer) noexcept;

/// A datagram an answer. Throws Error.
[[nodiscard]] std::unique_ptr<Output> udp_output(const cell::UdpEntry& to);

}  // namespace depthgrid::monitor
