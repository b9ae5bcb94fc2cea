// Lens distortion of a depth camera and its removal from depth images.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"

namespace depthgrid {

/// Distortion of normalised image coordinates (x/z, y/z), in OpenCV's order of coefficients:
/// k1 k2 p1 p2 k3 (plumb-bob = Brown-Conrady), then k4 k5 k6 (rational); k1 k2 k3 k4 of theta (1 + k1 theta^2 + ... +
/// k4 theta^8) for equidistant, which is OpenCV's fisheye, ROS's and Kalibr's equidistant: the model of Kannala and
/// Brandt (IEEE PAMI 2006), theta the angle between ray and axis.
struct Distortion {
  enum class Model : std::uint8_t { none, plumb_bob, rational, equidistant };
  Model model = Model::none;
  std::array<double, 8> coefficients{};  ///< k1 k2 p1 p2 k3 k4 k5 k6, or k1 k2 k3 k4; unused ones are 0
};

/// False also for plumb_bob and rational with coefficients that are all 0, which calibration files may well name;
/// equidistant bends rays whatever its coefficients are.
[[nodiscard]] bool distorts(const Distortion& distortion) noexcept;

/// "none", "plumb_bob", "rational", "equidistant".
[[nodiscard]] std::string_view to_string(Distortion::Model model) noexcept;

/// The model by the names above and by those that OpenCV, ROS, Kalibr and RealSense have for it (radtan,
/// rational_polynomial, fisheye ...); none: it is not known.
[[nodiscard]] std::optional<Distortion::Model> distortion_model(std::string_view name) noexcept;

/// Builds a distortion from the coefficients of a calibration file: none takes 0 (or only zeros), plumb_bob 4 or 5,
/// rational 8, equidistant 4. Throws Error on another count or a non-finite value.
Distortion make_distortion(Distortion::Model model, std::span<const double> coefficients);

/// Undistorted to distorted normalised coordinates (the forward model).
[[nodiscard]] Eigen::Vector2d distort(const Distortion& distortion, const Eigen::Vector2d& normalised) noexcept;

/// Throws Error where the coefficients of an equidistant lens map two rays less than 90 degrees off the axis to one
/// place of the image: those are of another model or image size. Other models fold where their lens ends, and such
/// pixels are "no measurement" to DepthUndistortion.
void refuse_fold(const PinholeCamera& camera, const Distortion& lens);

/// Removes the distortion of a depth image. Each pixel of the result is the minimum over all source pixels that its
/// square touches, and "no measurement" as soon as one of them is none or lies outside the source: never a blend of
/// two depths, never farther than any of them. The pixel lists are prepared once; apply() does not allocate.
///
/// The source pixels of a square form a rectangle that encloses the square's image: the mean value form over the whole
/// square, so no touched pixel is missed and at worst a neighbour at a corner is added. Squares that lie where the
/// model folds back (the lens does not image them) are "no measurement".
class DepthUndistortion {
 public:
  /// `distorted` are the intrinsics of the source image, `undistorted` those of the result: rectified_camera()
  /// (core/rectification.hpp) loses nothing of what the lens sees. Throws Error when the distortion cannot be evaluated
  /// (non-finite) over the image that `distorted` would have without a lens, and as refuse_fold() or validate().
  ///
  /// `lateral_px`: a nearer surface may hide so many source pixels beside a reading (SensorMargin::lateral_px). Who
  /// filters the result by as many of its own pixels covers that, but not where one source pixel became several: there
  /// the source pixels around the rectangle count, too.
  DepthUndistortion(const PinholeCamera& distorted, const Distortion& lens, const PinholeCamera& undistorted,
                    int lateral_px);

  /// `source` (0 = no measurement) and `result` must have the sizes given to the constructor (other sizes give a
  /// result without measurements) and be different images. Threads may share the object.
  void apply(const DepthImage& source, DepthImage& result) const noexcept;

  /// Of each source pixel, row-major, whether some pixel of the result reads it: what is not read is cut off.
  [[nodiscard]] std::vector<bool> pixels_read() const;

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
