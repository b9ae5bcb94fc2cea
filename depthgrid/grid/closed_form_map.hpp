// The relation between a cell of the depth grid and the pixels of a secondary camera, computed instead of stored.
//
// Along the ray of principal pixel (u, v) the projection into a secondary camera is q(d) = d A + B with A = K R r and
// B = K t; pixel = (q_x / q_z, q_y / q_z) and depth = q_z. A is affine in u and v, so a ray costs six multiply-adds.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/grid/depth_grid.hpp"

namespace depthgrid::grid {

/// A camera of the rig other than the principal one.
struct SecondaryCamera {
  PinholeCamera camera;
  Pose T_secondary_principal = Pose::Identity();
};

/// A pixel of a secondary camera that monitors a cell, and d_start, the smallest depth of the cell in that camera.
struct CellPixel {
  int u_px = 0;
  int v_px = 0;
  float d_start_m = 0;
};

/// What a secondary camera says of a cell.
enum class Confirmation : std::uint8_t {
  not_involved,  ///< the cell does not project into its image, or reaches behind it
  confirmed,     ///< it measures something in front of the cell, or has no measurement there
  denied,        ///< it sees past the front of the cell
};

/// The letter's test: the camera confirms an obstacle when its depth in that pixel is smaller than d_start. A pixel
/// without measurement (0) frees nothing, so it confirms as well.
[[nodiscard]] inline Confirmation confirm(float measured_m, float d_start_m) noexcept {
  return measured_m < d_start_m ? Confirmation::confirmed : Confirmation::denied;
}

/// Map storage that needs no memory. Immutable after construction.
class ClosedFormMap {
 public:
  /// One principal pixel seen from one secondary camera: its coefficients, so that several cells can be computed at
  /// once.
  struct Line {
    const float* centre_m;  ///< centre of cell n; readable from -kPadding to count + kPadding - 1
    const float* front_m;   ///< the end of cell n that is nearer to the secondary camera; readable as above
    float a_x, a_y, a_z, a_z_smallest;
    float b_x, b_y, b_z;
    float width_px, height_px;
  };
  /// Cells that may be read, without meaning, on either side of the grid.
  static constexpr int kPadding = 16;

  /// One principal pixel seen from one secondary camera.
  class Ray {
   public:
    Ray() = default;
    explicit Ray(const Line& line) noexcept : line_(line) {}

    /// The pixel that contains the projection of the cell's centre. False when that is outside the image or the cell
    /// reaches behind the camera. 0 <= n < count.
    [[nodiscard]] bool pixel(int n, CellPixel& result) const noexcept {
      const float centre_m = line_.centre_m[n];
      const float d_start_m = line_.front_m[n] * line_.a_z_smallest + line_.b_z;
      if (!(d_start_m > 0.0F)) {
        return false;
      }
      const float inverse = 1.0F / (centre_m * line_.a_z + line_.b_z);
      const float x_px = (centre_m * line_.a_x + line_.b_x) * inverse;
      const float y_px = (centre_m * line_.a_y + line_.b_y) * inverse;
      if (!(x_px >= 0.0F && y_px >= 0.0F && x_px < line_.width_px && y_px < line_.height_px)) {
        return false;
      }
      result = {static_cast<int>(x_px), static_cast<int>(y_px), d_start_m};
      return true;
    }

    /// The letter's confirmation by this camera; `depth_m` is its dense depth image (0 = no measurement).
    [[nodiscard]] Confirmation confirm(int n, const float* depth_m) const noexcept {
      CellPixel p;
      if (!pixel(n, p)) {
        return Confirmation::not_involved;
      }
      return grid::confirm(depth_m[p.v_px * static_cast<int>(line_.width_px) + p.u_px], p.d_start_m);
    }

    [[nodiscard]] const Line& line() const noexcept { return line_; }

   private:
    Line line_;  // uninitialised by default: arrays of rays are filled per pixel, camera by camera
  };

  /// Throws Error when a secondary camera's intrinsics are invalid or its pose is not finite.
  ClosedFormMap(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries);

  [[nodiscard]] std::size_t camera_count() const noexcept { return cameras_.size(); }
  /// (u, v) is a pixel of the principal camera, k < camera_count(). The ray refers to this map.
  [[nodiscard]] Ray ray(int u, int v, std::size_t k) const noexcept;
  /// Equal maps give equal answers in every cell.
  [[nodiscard]] bool operator==(const ClosedFormMap& other) const noexcept {
    return boundary_m_ == other.boundary_m_ && centre_m_ == other.centre_m_ && cameras_ == other.cameras_;
  }

 private:
  struct Camera {
    std::array<std::array<float, 3>, 3> a;  ///< A = a[.][0] + u a[.][1] + v a[.][2] at the pixel's centre
    std::array<float, 3> b;
    float half_spread_z;  ///< largest deviation of A_z inside the pixel
    float width_px, height_px;
    bool operator==(const Camera&) const = default;
  };
  /// Single-precision depths of the cells, with kPadding values on either side.
  std::vector<float> boundary_m_;
  std::vector<float> centre_m_;
  std::vector<Camera> cameras_;
};

inline ClosedFormMap::Ray ClosedFormMap::ray(int u, int v, std::size_t k) const noexcept {
  const Camera& camera = cameras_[k];
  const auto x = static_cast<float>(u);
  const auto y = static_cast<float>(v);
  const float a_z = camera.a[2][0] + x * camera.a[2][1] + y * camera.a[2][2];
  const float a_z_smallest = a_z - camera.half_spread_z;
  // Where depth falls along the ray the cell's far end is the one nearer to the secondary camera.
  const int front_shift = a_z_smallest < 0.0F ? 1 : 0;
  return Ray({centre_m_.data() + kPadding, boundary_m_.data() + kPadding + front_shift,
              camera.a[0][0] + x * camera.a[0][1] + y * camera.a[0][2],
              camera.a[1][0] + x * camera.a[1][1] + y * camera.a[1][2], a_z, a_z_smallest, camera.b[0], camera.b[1],
              camera.b[2], camera.width_px, camera.height_px});
}

}  // namespace depthgrid::grid
