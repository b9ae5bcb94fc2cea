#include "depthgrid/avoidance/history_port.hpp"

namespace depthgrid::avoidance {

bool HistoryPort::read(control::JointState& state) noexcept {
  if (!port_.read(state)) {
    return false;
  }
  const std::span<const double> q(state.position_rad.data(), static_cast<std::size_t>(state.position_rad.size()));
  refused_ += history_.add(state.time_s, q) ? 0 : 1;
  return true;
}

}  // namespace depthgrid::avoidance
