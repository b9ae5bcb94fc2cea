// Joint positions of the last moments: where the joints were at the time of an exposure.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace depthgrid::robot {

/// How an answer came about; only the first two have positions.
enum class JointAnswer : std::uint8_t {
  interpolated,  ///< between two samples
  held,          ///< the newest sample, older than the time asked for by time_error_s
  no_samples,
  too_old,  ///< before the oldest sample still kept
  too_new,  ///< later than the newest sample by more than max_hold_s, or not a number
  gap,      ///< the two samples around lie farther apart than max_gap_s
};

struct JointsAtTime {
  JointAnswer answer = JointAnswer::no_samples;
  /// How far the time lies behind the newest sample; 0 where interpolated. Pad the robot for it (motion_padding.hpp).
  double time_error_s = 0;

  [[nodiscard]] bool known() const noexcept {
    return answer == JointAnswer::interpolated || answer == JointAnswer::held;
  }
};

/// What a history holds at some moment: what is added later does not count for who asks with it.
struct JointMoment {
  std::uint64_t samples = 0;  ///< ever added
  double newest_s = 0;        ///< of the last of them; no matter without samples
};

/// A ring of samples. One thread adds, any number ask at the same time; neither locks nor allocates nor throws.
/// Positions are interpolated linearly: over samples h apart that errs by at most h^2 / 8 times the joint's
/// acceleration (2 ms, 10 rad/s^2: 5e-6 rad). A continuous joint's positions must not jump by a turn.
class JointHistory {
 public:
  /// Keeps the last `capacity` samples of `joints` positions. max_gap_s: the longest time to interpolate over;
  /// max_hold_s: how long the newest sample may stand for later times, 0 for never. Throws Error when joints is 0,
  /// capacity is less than 2, max_gap_s is not positive, or max_hold_s is negative or not a number.
  JointHistory(std::size_t joints, std::size_t capacity, double max_gap_s, double max_hold_s);

  /// Positions q (rad or m) at time_s, on the clock of the cameras. False, and nothing added, when the time is not
  /// later than the last one, a number is not finite or the size is wrong.
  bool add(double time_s, std::span<const double> q) noexcept;
  /// Whether add() would; for the thread that adds.
  [[nodiscard]] bool can_add(double time_s, std::span<const double> q) const noexcept;

  /// What it holds now. Of several calls with one moment the answers fit together, and come again with the same
  /// samples.
  [[nodiscard]] JointMoment now() const noexcept;

  /// Positions at time_s into q, which has one element a joint (else `no_samples`). q is arbitrary where they are not
  /// known. `known`: a moment of this history.
  [[nodiscard]] JointsAtTime at(double time_s, std::span<double> q) const noexcept { return at(time_s, q, now()); }
  [[nodiscard]] JointsAtTime at(double time_s, std::span<double> q, const JointMoment& known) const noexcept;

  /// How far each joint may be from q (what at(time_s) gave) at any time within time_error_s of time_s, into away: rad
  /// or m. Where samples lie around that window it is what they moved; between two of them h apart a joint leaves the
  /// line by at most A h^2 / 8, and by (V h - dq^2 / (V h)) / 2; after the newest it goes on with the speed v of the
  /// last two: by (|v| + A h) t + A t^2 / 2, and by V t. V: most_speed, A: most_acceleration, one a joint, not
  /// negative, infinite where not known. False, and nothing is known, where the samples do not reach back that far,
  /// where the window holds a gap longer than max_gap_s, or a size is wrong.
  [[nodiscard]] bool greatest_motion(double time_s, double time_error_s, std::span<const double> q,
                                     std::span<const double> most_speed, std::span<const double> most_acceleration,
                                     std::span<double> away) const noexcept {
    return greatest_motion(time_s, time_error_s, q, most_speed, most_acceleration, away, now());
  }
  [[nodiscard]] bool greatest_motion(double time_s, double time_error_s, std::span<const double> q,
                                     std::span<const double> most_speed, std::span<const double> most_acceleration,
                                     std::span<double> away, const JointMoment& known) const noexcept;

 private:
  /// Sample i is complete while `version` is 2 i + 2; it is odd while the slot is written.
  struct Slot {
    std::atomic<std::uint64_t> version{0};
    std::atomic<double> time_s{0};
  };
  [[nodiscard]] bool read_time(std::uint64_t sample, double& time_s) const noexcept;
  /// q = a q + b (positions of the sample). False when the sample was replaced.
  [[nodiscard]] bool add_positions(std::uint64_t sample, double a, double b, std::span<double> q) const noexcept;
  /// The last sample not later than time_s, among those kept of `count`. False when there is none.
  [[nodiscard]] bool last_before(double time_s, std::uint64_t count, std::uint64_t& sample) const noexcept;
  [[nodiscard]] double position(std::uint64_t sample, std::size_t joint) const noexcept;

  std::size_t joints_;
  double max_gap_s_;
  double max_hold_s_;
  double last_time_s_;  ///< of the adding thread
  std::vector<Slot> slots_;
  std::vector<std::atomic<double>> positions_;  ///< joints_ a slot
  std::atomic<std::uint64_t> count_{0};         ///< samples ever added
};

}  // namespace depthgrid::robot
