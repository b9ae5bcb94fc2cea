#include "depthgrid/avoidance/history_port.hpp"

namespace depthgrid::avoidance {

bool HistoryPort::read(control::JointState& state) noexcept {
  if (!port_.read(state)) {
    return false;
  }
  (void)history_.add(state.time_s, {state.position_rad.data(), static_cast<std::size_t>(state.position_rad.size())});
  return true;
}

}  // namespace depthgrid::avoidance
