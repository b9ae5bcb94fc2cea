// How a pixel's stored value becomes the depth that is known to be free before its neighbours are asked: constants that
// are worked out once for each camera. Internal.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"

namespace depthgrid::views {

/// x (slope - curve x) - constant in single precision, one rounding an operation, is never above D - m(D) of the depth
/// D that x stands for, and below it by less than 2^-20 D. Without any margin the result for metres is x itself.
struct Reduction {
  float slope;
  float curve;
  float constant_m;
};

/// Reduced depths below this count as 0, so that nothing underflows.
inline constexpr float kSmallestReduced = 1e-30F;

/// One camera's rule and margin, for both formats of images.
struct Reading {
  /// As validate() of both wants them.
  Reading(const MeasurementRule& rule, double metres_per_unit, const SensorMargin& margin);

  // 16-bit values. A value's code is 0 for no measurement, beyond_code for every value that counts as the far limit,
  // or the value itself, which then is x.
  double metres_per_unit;
  std::uint16_t lowest_code = 1;             ///< what is below is no measurement
  std::uint16_t highest_unit = 0;            ///< the last value that stands for itself
  std::uint16_t beyond_code = 1;             ///< highest_unit + 1
  bool has_beyond = false;                   ///< values above highest_unit count as the far limit, not as none
  std::vector<std::uint16_t> invalid_units;  ///< no measurements wherever they lie
  float beyond_m = 0;                        ///< the far limit
  float beyond_value = 0;                    ///< the x that stands for it
  Reduction of_units;
  bool ascending = false;  ///< a higher code never has a lower reduced depth

  // Metres: x in [lowest, highest] are measurements; what is higher, and finite, counts as beyond_highest_m (0: none).
  float lowest_m;
  float highest_m;
  float beyond_highest_m;
  Reduction of_metres;
};

/// The last value that stands for a depth of no more than this: a reading by the rule, else 0.
[[nodiscard]] std::uint16_t units_not_above(const Reading& reading, double depth_m) noexcept;
[[nodiscard]] float metres_not_above(const Reading& reading, double depth_m) noexcept;

}  // namespace depthgrid::views
