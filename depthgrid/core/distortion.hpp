// Lens distortion of a depth camera and its removal from depth images.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"

namespace depthgrid {

/// Distortion of normalised image coordinates (x/z, y/z), in OpenCV's order of coefficients:
/// k1 k2 p1 p2 k3 (plumb-bob = Brown-Conrady), then k4 k5 k6 (rational).
struct Distortion {
  enum class Model : std::uint8_t { none, plumb_bob, rational };
  Model model = Model::none;
  std::array<double, 8> coefficients{};  ///< k1 k2 p1 p2 k3 k4 k5 k6; unused ones are 0
};

/// False also for a model whose coefficients are all 0, which calibration files may well name.
[[nodiscard]] bool distorts(const Distortion& distortion) noexcept;

/// Builds a distortion from the coefficients of a calibration file: none takes 0 (or only zeros), plumb_bob 4 or 5,
/// rational 8. Throws Error on another count or a non-finite value.
Distortion make_distortion(Distortion::Model model, std::span<const double> coefficients);

/// Undistorted to distorted normalised coordinates (the forward Brown-Conrady / rational model).
[[nodiscard]] Eigen::Vector2d distort(const Distortion& distortion, const Eigen::Vector2d& normalised) noexcept;

/// Removes the distortion of a depth image. Each pixel of the result is the minimum over all source pixels that its
/// square touches, and "no measurement" as soon as one of them is none or lies outside the source: never a blend of
/// two depths, never farther than any of them. The pixel lists are prepared once; apply() does not allocate.
///
/// The source pixels of a square form a rectangle that encloses the square's image: the mean value form over the whole
/// square, so no touched pixel is missed and at worst a neighbour at a corner is added. Squares that lie where the
/// model folds back (the lens does not image them) are "no measurement".
class DepthUndistortion {
 public:
  /// `distorted` are the intrinsics of the source image, `undistorted` those of the result (often the same).
  /// Throws Error when the distortion cannot be evaluated (non-finite) over the result's image, or as validate().
  DepthUndistortion(const PinholeCamera& distorted, const Distortion& lens, const PinholeCamera& undistorted);

  /// `source` (0 = no measurement) and `result` must have the sizes given to the constructor (other sizes give a
  /// result without measurements) and be different images. Threads may share the object.
  void apply(const DepthImage& source, DepthImage& result) const noexcept;

 private:
  struct SourceWindow {
    std::int16_t u_first, v_first, u_last, v_last;  ///< inclusive; u_last < u_first: touches the outside
  };
  int source_width_px_ = 0;
  int source_height_px_ = 0;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<SourceWindow> windows_;  ///< one for each pixel of the result, row-major
};

}  // namespace depthgrid
