// Why the loop limits or ends motion: a state, and a sentence for people.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "depthgrid/core/past.hpp"
#include "depthgrid/core/proximity.hpp"

namespace depthgrid::avoidance {

/// The later, the graver.
enum class MotionLimit : std::uint8_t {
  none,              ///< nothing within the laws' range
  obstacle,          ///< what is nearest to a part
  budget,            ///< the part's evaluation ended early: its bound is no distance yet
  blind_layer,       ///< the part's distance is no more than the layer around the robot is thick
  unknown_distance,  ///< the part has no distance
  no_images,         ///< brakes: no camera has an image that is new enough
  no_joint_state,    ///< brakes: the robot gave no state, or one that is not finite or of another robot
  clock,             ///< brakes: the time is not finite, went back, or stood still
};

/// Whether the loop brakes whatever the distances are.
[[nodiscard]] constexpr bool brakes(MotionLimit limit) noexcept { return limit >= MotionLimit::no_images; }

/// "none", "obstacle", ..., "clock".
[[nodiscard]] std::string_view to_string(MotionLimit limit) noexcept;

/// Of one cycle. Metres and seconds; what does not apply is NaN or nothing.
struct MotionReason {
  MotionLimit limit = MotionLimit::none;
  /// The part with the least room: its distance less its braking distance. An index into LoopSettings::parts.
  std::optional<std::size_t> part;
  std::string_view link;                                 ///< of that part; valid as long as the loop
  ProximityState state = ProximityState::not_evaluated;  ///< what is nearest to that part
  Unmeasured unmeasured = Unmeasured::not_told;          ///< and why, at `unmeasured`
  Past past;                                             ///< what a memory knows of that place
  double time_s = Proximity::kNaN;                       ///< of the cycle
  double clear_m = Proximity::kNaN;                      ///< the distance that the laws took for it
  /// How far that part may go until it stands when every joint brakes at its own deceleration, with the Jacobian of
  /// now. Where the loop brakes: the farthest that any part goes.
  double braking_m = Proximity::kNaN;
  std::optional<std::size_t>
      late_camera;                  ///< the one without a new image for longest; space that only it sees is unknown
  double late_s = Proximity::kNaN;  ///< since its last image, or since the last joint state; NaN: there was none
  /// Images that showed a surface where nothing could be (ImpossibleSurfaces), so far, and when the last of them was
  /// exposed, in seconds before the cycle.
  std::int64_t impossible_images = 0;
  double impossible_s = Proximity::kNaN;
};

/// One sentence, at most as long as the buffer; 480 characters are enough. Locks and allocates nothing.
[[nodiscard]] std::string_view describe(const MotionReason& reason, std::span<char> buffer) noexcept;

}  // namespace depthgrid::avoidance
