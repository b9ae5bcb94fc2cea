// What a running cell counts, as text for Prometheus.
#pragma once

#include <string>

#include "depthgrid/monitor/monitor.hpp"

namespace depthgrid::monitor {

/// The text format 0.0.4: counters since the start, the newest answer's distances, ages and states of cameras,
/// quantiles of times. Metres and seconds; what is not known is NaN. Names begin with "depthgrid_". For any thread.
/// `has_ended`: nobody answers any more, so that stop is 1, no camera is live, and there is no distance.
[[nodiscard]] std::string prometheus_text(const Monitor& monitor, const CellAnswer& newest, bool has_ended = false);

}  // namespace depthgrid::monitor
