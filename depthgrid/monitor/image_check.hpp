// Whether an image that a source gives is one: its time, and whether it is new. Internal.
#pragma once

#include <cstdint>

#include "depthgrid/core/depth_image.hpp"

namespace depthgrid::monitor {

enum class ImageVerdict : std::uint8_t {
  new_image,
  from_the_future,  ///< later than now by more than the clocks' tolerance, or no time at all
  too_old,          ///< older than images count
  not_newer,        ///< not later than the one before: doubled, or out of order
  equal_pixels,     ///< the same pixels as the one before, with a new time: the source is frozen
};

/// How far in the future an exposure may seem to lie, on clocks that agree not quite.
inline constexpr double kFuture_s = 0.005;

/// One source's images, one after the other. Locks and allocates nothing.
class ImageCheck {
 public:
  /// equal_allowed: pixels may repeat, as ideal images of a scene that stands do.
  ImageCheck(double max_age_s, bool equal_allowed) : max_age_s_(max_age_s), equal_allowed_(equal_allowed) {}

  /// `is_empty`: not one pixel has a reading; then a second such image is none the less news.
  [[nodiscard]] ImageVerdict look(const DepthView& depth, bool is_empty, double time_s, double now_s) noexcept;
  /// The source was opened anew.
  void begin_anew() noexcept { has_pixels_ = false; }

 private:
  double max_age_s_;
  bool equal_allowed_;
  bool has_time_ = false;
  bool has_pixels_ = false;
  double newest_s_ = 0;
  std::uint64_t pixels_ = 0;
};

/// A number that differs, but for one case in 2^64, where pixels differ. 0 for an image without data.
[[nodiscard]] std::uint64_t pixel_hash(const DepthView& depth) noexcept;

}  // namespace depthgrid::monitor
