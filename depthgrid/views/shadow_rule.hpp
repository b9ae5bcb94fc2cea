// What a pixel without a reading may still say where the sensor's second view, its projector or other imager, is
// blocked by something that the image shows. Internal.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/views/hole_bounds.hpp"
#include "depthgrid/views/reading.hpp"

namespace depthgrid::views {

/// Makes of an image one in which the shadow bands beside near things hold the depth that they count as.
///
/// Assumption: rows are epipolar lines, so at depth z a place appears delta(z) = f |x| / z columns farther to one side
/// in the second view, x being where that stands. What the camera sees and the second view sees, too, gives a reading;
/// the second view covers at least the camera's field of view; nothing is nearer than near_m. Then a pixel u has no
/// reading because something hides it from the second view, at a pixel u' > u towards it, and
///
///     delta <= h(u) + 1,     h(u) = max over u' > u of delta(u') - (u' - u),
///
/// the 1 for where in the two pixels the edges are. So nothing at u is nearer than f |x| / (h(u) + 1).
///
/// Kept strict: delta(u') is of the reading less its margin, the largest of the filter radius w above and below; where
/// one of the next w pixels does not belong to a band, so that the filter may not lower this one, w is added; what may
/// stand beside the image, on the second view's side, casts its shadow, too, as near as near_m; and where the second
/// view's image may end, on the other side, nothing is said. A hole counts as band only where the third part of the
/// assumption is likely: the least delta of the last three readings on its other side is at most h + 1.5.
///
/// What is written is enough for the sensor's margin to be subtracted afterwards as if the pixel had read so. Buffers
/// are allocated by the constructor; one thread at a time.
class ShadowRule {
 public:
  /// `second_view_x_m`: where the second view stands along the image's x axis, not 0; near_m is not 0 either.
  ShadowRule(const PinholeCamera& camera, double metres_per_unit, const MeasurementRule& rule,
             const SensorMargin& margin, double second_view_x_m);

  /// `depth` is one of the camera (core/usable_frame.hpp) with its stride. The result is dense, of the same format, and
  /// lies in this object's memory until the next call.
  /// With `rims` the pixels to which w was added stay without a reading, as long as there is room for them in it: what
  /// they are written as otherwise is `least`; `most` is that without w where the filter lowers others by it. Next to
  /// the band's cause w is a long way in depth, and a small hole there says more (HoleRule::fill).
  [[nodiscard]] DepthView fill(const DepthView& depth, std::vector<HoleBounds>* rims = nullptr) noexcept;

 private:
  static constexpr std::size_t kRowsAtOnce = 4;
  struct Row {
    std::vector<float> tall;
    std::vector<float> hidden;
  };

  /// Column of the image at place i of a row of deltas, which run towards the second view.
  [[nodiscard]] int column(int i) const noexcept { return towards_right_ ? i : width_px_ - 1 - i; }
  [[nodiscard]] float* deltas(int v) noexcept;
  void read_row(const DepthView& depth, int v) noexcept;
  /// The largest delta of the rows around v, for all columns.
  void widen(int v, Row& row) noexcept;
  /// h of all rows_.
  void find_hidden() noexcept;
  /// Of up to three readings before a place.
  [[nodiscard]] static float least_of_last(const float* delta, int end) noexcept;
  /// band_ of row v.
  void find_bands(int v, const Row& row) noexcept;
  void write_row(int v, const Row& row, std::vector<HoleBounds>* rims) noexcept;
  /// What nothing nearer than the way in the second view `most_px` counts as, in the image's format.
  [[nodiscard]] double counts_as_m(double most_px) const noexcept;

  int width_px_;
  int height_px_;
  int radius_px_;
  bool towards_right_;
  double reach_px_m_;  ///< f |x|
  double most_px_;     ///< the delta at near_m
  MeasurementRule rule_;
  SensorMargin margin_;
  Reading reading_;
  std::vector<float> delta_of_units_;
  std::vector<float> deltas_px_;  ///< a row each, kNone where there is no reading
  std::array<Row, kRowsAtOnce> rows_;
  std::vector<std::uint8_t> band_;
  std::vector<std::uint16_t> filled_units_;
  std::vector<float> filled_m_;
  bool of_units_ = true;
};

}  // namespace depthgrid::views
