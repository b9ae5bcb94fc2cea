// What a memory knows of a place where something may be: since when, and from where.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string_view>

namespace depthgrid {

enum class PastState : std::uint8_t {
  not_told,         ///< no memory, or one that says nothing
  never_ruled_out,  ///< nobody has seen it free so far, and nobody has declared it so
  possible_again,   ///< nothing could be there, until possible_since_s
  not_kept,         ///< outside of the memory's region
  ruled_out,        ///< by the newest images nothing can be there
};

/// From where something may have come to such a place, through places that nobody had seen free meanwhile.
enum class PastOrigin : std::uint8_t {
  not_told,  ///< the voxel itself was put back (measured, or let go by the robot), or what led there is forgotten
  never_ruled_out,  ///< from_world was never seen free
  not_kept,         ///< in over the border of the memory's region, at from_world
  earlier,          ///< something could be at from_world before; that is as far back as is remembered
};

/// - Frame and units: world, metres, seconds on the frames' clock.
/// - Of the memory's voxel that is nearest to the place, with the memory's resolution.
struct Past {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  PastState state = PastState::not_told;
  /// Until then nothing could be in the voxel, and no image since has seen it free: hidden for at least that long.
  double possible_since_s = kNaN;
  /// An image of then saw it free, or a link of the robot was in it, when something could have been there already. The
  /// last that did is of then or of later: places that nothing has come near are not looked at again. NaN: it was
  /// declared, not seen.
  double seen_free_s = kNaN;
  PastOrigin origin = PastOrigin::not_told;
  Eigen::Vector3d from_world = Eigen::Vector3d::Constant(kNaN);  ///< the middle of a voxel
  double from_m = kNaN;                                          ///< from there to the place, straight
};

/// "not told", "never ruled out", "possible again", "not kept", "ruled out".
[[nodiscard]] std::string_view to_string(PastState state) noexcept;

}  // namespace depthgrid
