#include "depthgrid/monitor/joint_line.hpp"

#include <exception>

#include "depthgrid/monitor/source_loop.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {
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
  const double time_s = sensors::seconds_of(sensors::nanoseconds_of(reading.time_s));  // as a recording holds it
  const bool of_now = reading.time_s <= now_s + kFuture_s && reading.time_s >= now_s - max_age_s_;
  // A state that is doubled or out of order adds nothing, and says nothing of the robot.
  const bool added = of_now && history_.can_add(time_s, reading.q);
  if (added) {
    if (recorder_ != nullptr) {  // before anybody can stand on it
      recorder_->joints(time_s, reading.q);
    }
    (void)history_.add(time_s, reading.q);
    newest_s_.store(time_s, std::memory_order_relaxed);
  }
  (added ? counters_.taken : counters_.refused).fetch_add(1, std::memory_order_relaxed);
  if (!of_now && !refusing_) {
    tell(EventKind::source_failed, "joint state refused: its time is another than the images'");
  }
  refusing_ = !of_now;
}

void JointLine::has_ended() noexcept {
  if (!has_ended_) {
    tell(EventKind::source_ended, "at their end");
  }
  has_ended_ = true;
}

void JointLine::has_failed() noexcept {
  counters_.failures.fetch_add(1, std::memory_order_relaxed);
  tell(EventKind::source_failed, source_->reason());
}

void JointLine::run(const std::stop_token& stop) noexcept { follow(*source_, sensors::JointReading{}, *this, stop); }

}  // namespace depthgrid::monitor
