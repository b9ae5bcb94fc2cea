#include "depthgrid/monitor/image_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace depthgrid::monitor {

std::uint64_t pixel_hash(const DepthView& depth) noexcept {
  if (depth.data == nullptr || depth.width_px <= 0 || depth.height_px <= 0) {
    return 0;
  }
  constexpr std::uint64_t kPrime = 0x9e3779b97f4a7c15ULL;
  constexpr int kTurn = 29;
  const std::ptrdiff_t row = row_bytes(depth.format, depth.width_px);
  const std::ptrdiff_t stride = depth.stride_bytes != 0 ? depth.stride_bytes : row;
  std::uint64_t hash = kPrime;
  for (int v = 0; v < depth.height_px; ++v) {
    const char* bytes = static_cast<const char*>(depth.data) + v * stride;
    for (std::ptrdiff_t at = 0; at < row; at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + at, static_cast<std::size_t>(std::min<std::ptrdiff_t>(8, row - at)));
      hash = (hash ^ word) * kPrime;
      hash ^= hash >> kTurn;
    }
  }
  return hash;
}

ImageVerdict ImageCheck::look(const DepthView& depth, bool is_empty, double time_s, double now_s) noexcept {
  if (!(time_s <= now_s + kFuture_s)) {
    return ImageVerdict::from_the_future;
  }
  if (!(time_s >= now_s - max_age_s_)) {
    return ImageVerdict::too_old;
  }
  if (has_time_ && time_s <= newest_s_) {
    return ImageVerdict::not_newer;
  }
  const std::uint64_t pixels = equal_allowed_ ? 0 : pixel_hash(depth);
  if (!equal_allowed_ && !is_empty && has_pixels_ && pixels == pixels_) {
    return ImageVerdict::equal_pixels;
  }
  has_time_ = true;
  has_pixels_ = true;
  newest_s_ = time_s;
  pixels_ = pixels;
  return ImageVerdict::new_image;
}

}  // namespace depthgrid::monitor
