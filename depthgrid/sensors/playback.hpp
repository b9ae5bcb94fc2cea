// When what was recorded happens again: one for all sources of a recording, so that they keep together.
#pragma once

#include <cstdint>

namespace depthgrid::sensors {

enum class Pace : std::uint8_t {
  as_recorded,       ///< at the recorded times; what is late is passed over
  as_fast_as_asked,  ///< next() never waits, and passes over nothing; times are those of the recording
};

/// - Units: seconds. Recorded times are the recording's own, clock times those of clock_now_s().
/// - Threads: any; nothing changes after construction.
class Playback {
 public:
  /// Of what was recorded from first_s to last_s. It begins with the construction. Throws Error unless
  /// first_s <= last_s. With `repeat` the next round begins kPause_s after the end: the scene jumps there, and answers
  /// of the first images of a round may stand on the end of the one before.
  Playback(double first_s, double last_s, bool repeat, Pace pace = Pace::as_recorded);

  static constexpr double kPause_s = 0.25;

  [[nodiscard]] double clock_s(double recorded_s, std::int64_t round) const noexcept;
  /// The round that is under way at a clock time; 0 without repetition.
  [[nodiscard]] std::int64_t round_at(double clock_s) const noexcept;
  [[nodiscard]] bool repeats() const noexcept { return repeats_; }
  [[nodiscard]] Pace pace() const noexcept { return pace_; }

 private:
  double first_s_;
  double round_s_;
  bool repeats_;
  Pace pace_;
  double begin_s_;
};

}  // namespace depthgrid::sensors
