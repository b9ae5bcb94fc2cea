// One camera's newest image, prepared for the search: free depths and their minimum pyramid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/views/pixel_range.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::views {

/// Overlapping extrema of an image: texel (i, j) of level L covers the pixels [i 2^L, (i + 4) 2^L) x
/// [j 2^L, (j + 4) 2^L) of the image. So a rectangle of pixels whose last and first texel columns (pixel >> L) differ
/// by at most 7, and its rows likewise, is covered by four texels, each side with less than 2^L pixels too many.
struct PyramidLevel {
  std::uint32_t offset = 0;  ///< of its first texel in the pyramid's buffer
  std::int32_t width = 0;
  std::int32_t height = 0;
};

/// Texel columns (or rows) that four texels can cover.
inline constexpr int kPyramidSpan = 8;

/// The levels of an image of this size; on the last one, the first such, the whole image spans at most kPyramidSpan
/// texel columns and rows. `total` becomes the number of texels of all levels.
[[nodiscard]] std::vector<PyramidLevel> pyramid_levels(int width_px, int height_px, std::size_t& total);

/// A prepared image. Buffers are allocated by the constructor; update() does not allocate. Written by one thread,
/// read by many once it is published.
class View {
 public:
  View(const RigCamera& camera, const CameraMargins& margins, const Policies& policies);
  ~View();
  View(View&&) noexcept;
  View& operator=(View&&) noexcept;
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// Takes a frame: normalises, subtracts the margin, applies the robot, the minimum filter and builds the pyramid.
  /// False when the frame is unusable (no data, another size or depth scale than the camera's, rows that overlap, half
  /// a robot view); then nothing is free.
  bool update(const Frame& frame, const Pose& T_world_camera) noexcept;
  /// Why update() finds a frame unusable, as a text that lives for ever; null: it is usable.
  [[nodiscard]] const char* why_unusable(const Frame& frame) const noexcept;

  [[nodiscard]] int width_px() const noexcept { return free_m_.width_px(); }
  [[nodiscard]] int height_px() const noexcept { return free_m_.height_px(); }
  [[nodiscard]] bool present() const noexcept { return present_; }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  /// Of the last frame, usable or not; where the rig says before the first.
  [[nodiscard]] const Pose& T_world_camera() const noexcept { return T_world_camera_; }

  /// Measured depth of a pixel of the image, 0 = no measurement.
  [[nodiscard]] float measured_m(int u, int v) const noexcept;
  /// A pixel's frustum is free between the blind zone and this depth: g, and where the pixel's robot interval
  /// [near, far] begins at or before g and ends behind it, that far end (what lies in the interval is the robot).
  /// Never above the exact g, and below it by less than 2^-20 of the depths that it is made of (1 um a metre).
  [[nodiscard]] const DepthImage& free_m() const noexcept { return free_m_; }
  /// Minima of free_m(), all levels.
  [[nodiscard]] const float* minima_m() const noexcept { return minima_m_.data(); }
  [[nodiscard]] const std::vector<PyramidLevel>& levels() const noexcept { return levels_; }

  /// True when some pixel has a robot interval that free_m() does not hold wholly: it begins beyond the free depth
  /// (something stands before the robot, or nothing was measured there) or in the blind zone. Such an interval is an
  /// island that is not an obstacle to this camera. Else the island images are not up to date.
  [[nodiscard]] bool has_islands() const noexcept { return has_islands_; }
  /// Per pixel [near, far] of the island; (+inf, -inf) where there is none.
  [[nodiscard]] const DepthImage& island_near_m() const noexcept { return island_near_m_; }
  [[nodiscard]] const DepthImage& island_far_m() const noexcept { return island_far_m_; }
  /// Maxima of island_near_m() and minima of island_far_m(), all levels.
  [[nodiscard]] const float* island_near_maxima_m() const noexcept { return island_near_maxima_m_.data(); }
  [[nodiscard]] const float* island_far_minima_m() const noexcept { return island_far_minima_m_.data(); }
  /// The columns outside of which each kBandRows rows have no islands.
  static constexpr int kBandRows = 8;
  [[nodiscard]] const PixelRange* island_bands() const noexcept { return island_bands_.data(); }

 private:
  struct Preparation;

  void clear() noexcept;
  void clear_islands() noexcept;
  void join_island_bands() noexcept;

  std::unique_ptr<Preparation> preparation_;
  AlignedVector<std::byte> kept_;  ///< the image as it came, without padding
  DepthFormat kept_format_ = DepthFormat::uint16_units;
  DepthImage free_m_;
  std::vector<PyramidLevel> levels_;
  AlignedVector<float> minima_m_;
  bool has_islands_ = false;
  DepthImage island_near_m_, island_far_m_;
  AlignedVector<float> island_near_maxima_m_, island_far_minima_m_;
  std::vector<PixelRange> island_bands_;
  Pose T_world_camera_;
  double time_s_ = 0;
  bool present_ = false;
};

}  // namespace depthgrid::views
