#include "depthgrid/monitor/joint_line.hpp"

#include <exception>

#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {
namespace {

constexpr double kJointSlice_s = 0.05;

}  // namespace

void JointLine::tell(EventKind kind, std::string_view words) noexcept {
  Event event;
  event.time_s = sensors::clock_now_s();
  event.kind = kind;
  event.say(words);
  events_.push(event);
}

bool JointLine::open() noexcept {
  try {
    source_->open();
    counters_.opened.fetch_add(1, std::memory_order_relaxed);
    tell(EventKind::source_open, source_->info().name);
    return true;
  } catch (const std::exception& error) {
    tell(EventKind::source_failed, error.what());
  } catch (...) {
    tell(EventKind::source_failed, "unknown error");
  }
  counters_.failures.fetch_add(1, std::memory_order_relaxed);
  return false;
}

void JointLine::take(const sensors::JointReading& reading) noexcept {
  const double now_s = sensors::clock_now_s();
  const bool of_now = reading.time_s <= now_s + kFuture_s && reading.time_s >= now_s - max_age_s_;
  // A state that is doubled or out of order adds nothing, and says nothing of the robot.
  const bool added = of_now && history_.add(reading.time_s, reading.q);
  if (added) {
    newest_s_.store(reading.time_s, std::memory_order_relaxed);
  }
  (added ? counters_.taken : counters_.refused).fetch_add(1, std::memory_order_relaxed);
  if (!of_now && !refusing_) {
    tell(EventKind::source_failed, "joint state refused: its time is another than the images'");
  }
  refusing_ = !of_now;
}

void JointLine::run(const std::stop_token& stop) noexcept {
  Backoff backoff;
  bool is_open = false;
  bool has_ended = false;
  sensors::JointReading reading;
  while (!stop.stop_requested()) {
    if (!is_open) {
      is_open = open();
      if (!is_open) {
        wait_s(backoff.next_s(), stop);
        continue;
      }
    }
    switch (source_->next(reading, kJointSlice_s)) {
      case sensors::Reading::got:
        take(reading);
        backoff.reset();
        break;
      case sensors::Reading::nothing:
        break;
      case sensors::Reading::ended:
        if (!has_ended) {
          tell(EventKind::source_ended, "at their end");
        }
        has_ended = true;
        wait_s(kJointSlice_s, stop);
        break;
      case sensors::Reading::failed:
        counters_.failures.fetch_add(1, std::memory_order_relaxed);
        tell(EventKind::source_failed, source_->reason());
        source_->close();
        is_open = false;
        wait_s(backoff.next_s(), stop);
        break;
    }
  }
  source_->close();
}

}  // namespace depthgrid::monitor
