// The avoidance loop on the real clock.
#pragma once

#include <cstdint>
#include <vector>

#include "lab/experiments/loop/loop_recording.hpp"

namespace depthgrid::experiments {

enum class LoopParts : std::uint8_t { nine_points, link_capsules };

/// Durations of cycles without frames arriving, one after the other.
struct FreeRun {
  std::vector<double> cycle_s;  ///< processor time of each cycle
  double wall_s = 0;            ///< of all of them together
  double evaluate_s = 0;        ///< of that, the distances
};

/// `cycles` for each of `snapshots` frames evenly spaced over the recording. The letter's evaluation for comparison:
/// Method::letter_two with nine points. What remembers sees the half second before each frame first. Throws Error when
/// a cycle or an image fails.
[[nodiscard]] FreeRun run_free(const LoopRecording& recording, Method method, LoopParts parts,
                               const AvoidanceSettings& settings, int snapshots, int cycles,
                               const search::Budget& budget);

/// One period on the real clock.
struct PeriodTimes {
  double late_s = 0;            ///< the cycle began this much after its time
  double took_s = 0;            ///< from its beginning to the command, wall clock
  double processor_s = 0;       ///< of that, the thread's processor time
  double evaluate_s = 0;        ///< of took_s, the distances
  bool frame_arriving = false;  ///< the other thread was taking a frame when the cycle ended
};

struct PacedRun {
  std::vector<PeriodTimes> periods;
  std::vector<double> frame_s;     ///< from the start of a frame's processing until the search may use it, both cameras
  std::int64_t failed_cycles = 0;  ///< of `periods`: cycle() returned false
  std::int64_t failed_frames = 0;  ///< of `frame_s`: images were not taken
  std::int64_t answered = 0;
  std::int64_t stopped_by_budget = 0;
  bool real_time_priority = false;  ///< the machine granted it
};

/// The loop every period for `duration_s`, in a thread of its own, frames at 30 Hz in another. `progress` gets seconds.
/// Cycles and images that fail are counted. Throws Error when the first images fail, and what `progress` throws.
[[nodiscard]] PacedRun run_paced(const LoopRecording& recording, LoopParts parts, const AvoidanceSettings& settings,
                                 double duration_s, const search::Budget& budget,
                                 const std::function<void(double)>& progress);

}  // namespace depthgrid::experiments
