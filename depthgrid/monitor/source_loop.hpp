// What a source's thread does: opens it, takes what comes, and opens it again when it is lost. Internal.
#pragma once

#include <stop_token>

#include "depthgrid/sensors/source.hpp"

namespace depthgrid::monitor {

/// How long to wait before a source is opened again: 0.1 s, then twice as long each time, at most 2 s.
class Backoff {
 public:
  [[nodiscard]] double next_s() noexcept;
  void reset() noexcept { wait_s_ = kFirst_s; }

  static constexpr double kFirst_s = 0.1;
  static constexpr double kLongest_s = 2;

 private:
  double wait_s_ = kFirst_s;
};

/// So long a thread waits for its source at most, before it looks whether it shall stop.
inline constexpr double kSourceSlice_s = 0.05;

/// Sleeps for that long, or until it is told to stop.
void wait_s(double seconds, const std::stop_token& stop) noexcept;

/// Until it is told to stop. `line` has open(), which says whether it is open, take(reading), has_nothing(),
/// has_ended(), and has_failed(); these do not throw.
template <class Source, class Reading, class Line>
void follow(Source& source, Reading reading, Line& line, const std::stop_token& stop) noexcept {
  Backoff backoff;
  bool is_open = false;
  while (!stop.stop_requested()) {
    if (!is_open) {
      is_open = line.open();
      if (!is_open) {
        wait_s(backoff.next_s(), stop);
        continue;
      }
    }
    switch (source.next(reading, kSourceSlice_s)) {
      case sensors::Reading::got:
        line.take(reading);
        backoff.reset();
        break;
      case sensors::Reading::nothing:
        line.has_nothing();
        break;
      case sensors::Reading::ended:
        line.has_ended();
        wait_s(kSourceSlice_s, stop);
        break;
      case sensors::Reading::failed:
        line.has_failed();
        source.close();
        is_open = false;
        wait_s(backoff.next_s(), stop);
        break;
    }
  }
  source.close();
}

}  // namespace depthgrid::monitor
