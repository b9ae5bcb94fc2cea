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

bool JointHistory::can_add(double time_s, std::span<const double> q) const noexcept {
  const auto finite = [](double value) { return std::isfinite(value); };
  return q.size() == joints_ && finite(time_s) && time_s > last_time_s_ && std::all_of(q.begin(), q.end(), finite);
}

// Release stores keep the odd version before the values for who reads a value; acquire loads keep the second look at
// the version behind the values.
bool JointHistory::add(double time_s, std::span<const double> q) noexcept {
  if (!can_add(time_s, q)) {
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

namespace {

/// How far a joint that moves at most so far in the time between two samples, and has moved so far, may leave the line
/// between them: V h away and back on the other side, (V^2 h^2 - dq^2) / (2 V h). Where it has moved farther than that
/// V was wrong, and says nothing.
double off_line_by_speed(double most, double moved) noexcept {
  if (std::abs(moved) > most * (1 + 1e-9)) {
    return std::numeric_limits<double>::infinity();
  }
  const double share = most > 0 ? std::min(1.0, std::abs(moved) / most) : 1.0;
  return std::isfinite(most) ? most * (1 - share * share) / 2 : most;
}

}  // namespace

double JointHistory::position(std::uint64_t sample, std::size_t joint) const noexcept {
  const auto index = static_cast<std::size_t>(sample % slots_.size());
  return positions_[index * joints_ + joint].load(std::memory_order_acquire);
}

bool JointHistory::last_before(double time_s, std::uint64_t count, std::uint64_t& sample) const noexcept {
  sample = count > slots_.size() ? count - slots_.size() : 0;
  double sample_s = 0;
  if (read_time(sample, sample_s) && sample_s > time_s) {
    return false;
  }
  for (std::uint64_t after = count; after - sample > 1;) {
    const std::uint64_t middle = sample + (after - sample) / 2;
    if (!read_time(middle, sample_s) || sample_s <= time_s) {
      sample = middle;
    } else {
      after = middle;
    }
  }
  return read_time(sample, sample_s) && sample_s <= time_s;
}

bool JointHistory::greatest_motion(double time_s, double time_error_s, std::span<const double> q,
                                   std::span<const double> most_speed, std::span<const double> most_acceleration,
                                   std::span<double> away, const JointMoment& known) const noexcept {
  const std::uint64_t count = known.samples;
  const bool sizes = q.size() == joints_ && most_speed.size() == joints_ && most_acceleration.size() == joints_ &&
                     away.size() == joints_;
  const double from_s = time_s - time_error_s;
  const double to_s = time_s + time_error_s;
  std::uint64_t first = 0;
  if (!sizes || count == 0 || !(time_error_s >= 0) || !last_before(from_s, count, first)) {
    return false;
  }
  std::fill(away.begin(), away.end(), 0.0);
  double begin_s = 0;
  bool read = read_time(first, begin_s);
  for (std::uint64_t i = first; read && i + 1 < count && begin_s <= to_s; ++i) {
    double end_s = 0;
    read = read_time(i + 1, end_s);
    const double gap_s = end_s - begin_s;
    if (gap_s > max_gap_s_) {
      return false;
    }
    const double enter = std::max(0.0, (from_s - begin_s) / gap_s);
    const double leave = std::min(1.0, (to_s - begin_s) / gap_s);
    for (std::size_t j = 0; j < joints_; ++j) {
      const double begin = position(i, j);
      const double moved = position(i + 1, j) - begin;
      const double off_line =
          std::min(most_acceleration[j] * gap_s * gap_s / 8, off_line_by_speed(most_speed[j] * gap_s, moved));
      const double entered = std::abs(begin + enter * moved - q[j]);
      const double left = std::abs(begin + leave * moved - q[j]);
      away[j] = std::max(away[j], std::max(entered, left) + off_line);
    }
    double still_s = 0;
    read = read && read_time(i, still_s) && still_s == begin_s && read_time(i + 1, still_s);
    begin_s = end_s;
  }
  double newest_s = 0;
  read = read && read_time(count - 1, newest_s);
  const double later_s = to_s - newest_s;
  if (!read || !(later_s > 0)) {
    return read;
  }
  double before_s = 0;
  const bool pair = count > 1 && read_time(count - 2, before_s);
  const double gap_s = newest_s - before_s;
  for (std::size_t j = 0; j < joints_; ++j) {
    const double newest = position(count - 1, j);
    const double speed = pair ? std::abs(newest - position(count - 2, j)) / gap_s + most_acceleration[j] * gap_s
                              : std::numeric_limits<double>::infinity();
    const double further =
        std::min(most_speed[j] * later_s, speed * later_s + most_acceleration[j] * later_s * later_s / 2);
    away[j] = std::max(away[j], std::abs(newest - q[j]) + further);
  }
  return (!pair || read_time(count - 2, before_s)) && read_time(count - 1, newest_s);
}

JointMoment JointHistory::now() const noexcept {
  JointMoment moment;
  moment.samples = count_.load(std::memory_order_acquire);
  if (moment.samples > 0 && !read_time(moment.samples - 1, moment.newest_s)) {
    return {};  // the ring went once around meanwhile
  }
  return moment;
}

JointsAtTime JointHistory::at(double time_s, std::span<double> q, const JointMoment& known) const noexcept {
  const std::uint64_t count = known.samples;
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
  std::uint64_t before = 0;
  double before_s = 0;
  if (!last_before(time_s, count, before) || !read_time(before, before_s)) {
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
