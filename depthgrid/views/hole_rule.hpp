// What a pixel without a reading may still say, if no obstacle is smaller than a declared size. Internal.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/views/hole_bounds.hpp"
#include "depthgrid/views/hole_passes.hpp"
#include "depthgrid/views/reading.hpp"

namespace depthgrid::views {

/// Makes of an image one in which pixels without a reading hold the depth that they count as.
///
/// Assumption: every obstacle is a union of balls of diameter s. Where a ball's image touches pixel p, a disc of
/// diameter s f / z lies in it that touches p as well, z being the centre's depth and f the focal length less the
/// cosine at the image's corner, since away from the axis the image is an ellipse. A reading may be of what stands
/// beside its pixel, as far as the filter of w pixels covers; so w pixels inwards, pixels in that disc show the ball,
/// or what stands before it. Let W be such that every disc of that diameter which touches p shows a reading. Then
/// nothing that reaches w pixels farther than p is nearer than
///
///     min(s f / (W + 2 w), the smallest reading within W of p) - s / 2,
///
/// since a ball's front is at most s / 2 before its centre; what only touches p reaches so far at a pixel within w,
/// whose value the minimum filter takes for p. Outside the image counts as a reading of 0.
///
/// W is an upper bound, as fine as hole_levels() has it. There is no connectivity and no threshold; readings stay as
/// they are. What is subtracted is enough for the sensor's margin to be subtracted afterwards as if the pixel had read
/// so. Buffers are allocated by the constructor; one thread at a time.
class HoleRule {
 public:
  /// `smallest_obstacle_m`: s, positive and finite, else throws Error.
  HoleRule(const PinholeCamera& camera, double metres_per_unit, const MeasurementRule& rule, const SensorMargin& margin,
           double smallest_obstacle_m);

  /// `depth` is one of the camera (core/usable_frame.hpp) with its stride. The result is dense, of the same format, and
  /// lies in this object's memory until the next call.
  /// `bounds`: of pixels without a reading, each at most once. They may come from another rule, as what a hole says is
  /// true beside it.
  [[nodiscard]] DepthView fill(const DepthView& depth, std::span<const HoleBounds> bounds = {}) noexcept;

  /// W of a pixel of the last image: 0 where there is a reading, infinite where the hole is too wide to say anything.
  [[nodiscard]] double width_px(int u, int v) const noexcept;

 private:
  struct CodeScale;
  /// Of HoleImage::least: no reading in its window.
  static constexpr std::size_t kNoReading = 65535;
  /// Where the readings around the pixels of a level are looked for.
  struct Window {
    int half_px;
    int texels;  ///< level of HoleImage::least
  };
  /// What pixels count as, worked out for all codes of HoleImage::least and all levels, in one format of images.
  template <class Value>
  struct Format {
    struct Bound {
      std::uint16_t first_code;  ///< of a least reading not before s f / W
      Value value;
    };
    AlignedVector<Value> of_code;
    std::vector<Bound> of_level;
    AlignedVector<Value> filled;
  };
  template <class Value, class Written>
  void prepare(const CodeScale& scale, const Written& written, Format<Value>& format);
  /// The depth that a pixel without a reading counts as where nothing before this holds a centre, not positive: none.
  [[nodiscard]] double depth_m(double bound_m) const noexcept;
  template <class Value>
  [[nodiscard]] Value value(int u, int v, std::size_t level, const Format<Value>& format) const noexcept;
  template <class Value>
  [[nodiscard]] const Value* fill(const DepthView& depth, std::span<const HoleBounds> bounds,
                                  Format<Value>& format) noexcept;

  double focal_px_;  ///< f
  double size_m_;
  SensorMargin margin_;
  Reading reading_;
  HoleImage image_;
  std::vector<Window> windows_;  ///< one a level
  Format<std::uint16_t> of_units_;
  Format<float> of_metres_;
};

}  // namespace depthgrid::views
