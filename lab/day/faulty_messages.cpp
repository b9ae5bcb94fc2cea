#include "lab/day/faulty_messages.hpp"

#include <algorithm>
#include <utility>

namespace depthgrid::lab {

std::vector<DeviceMessage> FaultyMessages::pass(const DeviceMessage& message, std::optional<DeviceFault> fault,
                                                double now_s) {
  constexpr double kHour_s = 3600;
  if (fault != before_) {
    held_.clear();
    before_ = fault;
  }
  if (!fault) {
    last_good_ = message;
    return {message};
  }
  DeviceMessage changed = message;
  std::vector<DeviceMessage> sent;
  switch (*fault) {
    case DeviceFault::drop:
    case DeviceFault::network:
    case DeviceFault::unplug:
      return {};
    case DeviceFault::restart:
      return {message};
    case DeviceFault::delay:
      held_.push_back(message);
      while (!held_.empty() && held_.front().time_s <= now_s - delay_s_) {
        sent.push_back(std::move(held_.front()));
        held_.pop_front();
      }
      return sent;
    case DeviceFault::freeze:
      changed.units = last_good_ ? last_good_->units : changed.units;
      break;
    case DeviceFault::reorder:
      held_.push_back(message);
      if (held_.size() == 2) {
        sent = {held_.back(), held_.front()};
        held_.clear();
      }
      return sent;
    case DeviceFault::duplicate:
      return {message, message};
    case DeviceFault::black:
      std::fill(changed.units.begin(), changed.units.end(), std::uint16_t{0});
      break;
    case DeviceFault::wrong_size:
      changed.height_px /= 2;
      changed.units.resize(changed.units.size() / 2);
      changed.q.resize(changed.q.size() / 2);
      break;
    case DeviceFault::fast_clock:
      changed.time_s += kHour_s;
      break;
    case DeviceFault::slow_clock:
      changed.time_s -= kHour_s;
      break;
  }
  return {changed};
}

}  // namespace depthgrid::lab
