#include "depthgrid/robot/joint_history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

JointHistory::JointHistory(std::size_t joints, std::size_t capacity, double max_gap_s, double max_hold_s)
    : joints_(joints),
      max_gap_s_(max_gap_s),
      max_hold_s_(max_hold_s),
      last_time_s_(-std::numeric_limits<double>::infinity()),
      slots_(capacity),
      positions_(joints * capacity) {
  if (joints == 0) {
    fail("joint history: there are no joints");
  }
  if (capacity < 2) {
    fail("joint history: capacity is ", capacity, ", must be at least 2");
  }
  if (!(max_gap_s > 0)) {
    fail("joint history: the largest gap is ", max_gap_s, " s, must be positive");
  }
  if (!(max_hold_s >= 0)) {
    fail("joint history: the newest sample holds for ", max_hold_s, " s, must not be negative");
  }
}

// Release stores keep the odd version before the values for who reads a value; acquire loads keep the second look at
// the version behind the values.
bool JointHistory::add(double time_s, std::span<const double> q) noexcept {
  const auto finite = [](double value) { return std::isfinite(value); };
  if (q.size() != joints_ || !finite(time_s) || !(time_s > last_time_s_) || !std::all_of(q.begin(), q.end(), finite)) {
    return false;
  }
  const std::uint64_t sample = count_.load(std::memory_order_relaxed);
  const auto index = static_cast<std::size_t>(sample % slots_.size());
  Slot& slot = slots_[index];
  slot.version.store(2 * sample + 1, std::memory_order_relaxed);
  slot.time_s.store(time_s, std::memory_order_release);
  for (std::size_t j = 0; j < joints_; ++j) {
    positions_[index * joints_ + j].store(q[j], std::memory_order_release);
  }
  slot.version.store(2 * sample + 2, std::memory_order_release);
  count_.store(sample + 1, std::memory_order_release);
  last_time_s_ = time_s;
  return true;
}

bool JointHistory::read_time(std::uint64_t sample, double& time_s) const noexcept {
  const Slot& slot = slots_[static_cast<std::size_t>(sample % slots_.size())];
  const bool there = slot.version.load(std::memory_order_acquire) == 2 * sample + 2;
  time_s = slot.time_s.load(std::memory_order_acquire);
  return there && slot.version.load(std::memory_order_relaxed) == 2 * sample + 2;
}

bool JointHistory::add_positions(std::uint64_t sample, double a, double b, std::span<double> q) const noexcept {
  const auto index = static_cast<std::size_t>(sample % slots_.size());
  const Slot& slot = slots_[index];
  const bool there = slot.version.load(std::memory_order_acquire) == 2 * sample + 2;
  for (std::size_t j = 0; j < joints_; ++j) {
    q[j] = a * q[j] + b * positions_[index * joints_ + j].load(std::memory_order_acquire);
  }
  return there && slot.version.load(std::memory_order_relaxed) == 2 * sample + 2;
}

JointsAtTime JointHistory::at(double time_s, std::span<double> q) const noexcept {
  const std::uint64_t count = count_.load(std::memory_order_acquire);
  if (count == 0 || q.size() != joints_) {
    return {JointAnswer::no_samples, 0};
  }
  // A sample that is replaced meanwhile is older than all that are asked for, or the answer is `too_old`.
  double newest_s = 0;
  if (!read_time(count - 1, newest_s)) {
    return {JointAnswer::too_old, 0};
  }
  std::fill(q.begin(), q.end(), 0.0);
  if (!(time_s <= newest_s)) {
    if (!(time_s - newest_s <= max_hold_s_)) {
      return {JointAnswer::too_new, 0};
    }
    const bool read = add_positions(count - 1, 0, 1, q);
    return {read ? JointAnswer::held : JointAnswer::too_old, time_s - newest_s};
  }
  std::uint64_t before = count > slots_.size() ? count - slots_.size() : 0;  // the last sample not later than time_s
  double before_s = 0;
  if (read_time(before, before_s) && before_s > time_s) {
    return {JointAnswer::too_old, 0};
  }
  for (std::uint64_t after = count; after - before > 1;) {
    const std::uint64_t middle = before + (after - before) / 2;
    double middle_s = 0;
    if (!read_time(middle, middle_s) || middle_s <= time_s) {
      before = middle;
    } else {
      after = middle;
    }
  }
  if (!read_time(before, before_s) || before_s > time_s) {
    return {JointAnswer::too_old, 0};
  }
  if (before_s == time_s) {
    return {add_positions(before, 0, 1, q) ? JointAnswer::interpolated : JointAnswer::too_old, 0};
  }
  double after_s = 0;
  if (!read_time(before + 1, after_s)) {
    return {JointAnswer::too_old, 0};
  }
  if (after_s - before_s > max_gap_s_) {
    return {JointAnswer::gap, 0};
  }
  const double part = (time_s - before_s) / (after_s - before_s);
  const bool read = add_positions(before, 0, 1 - part, q) && add_positions(before + 1, 1, part, q);
  return {read ? JointAnswer::interpolated : JointAnswer::too_old, 0};
}

}  // namespace depthgrid::robot
