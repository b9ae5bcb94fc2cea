// How well two cameras of a rig agree, as measured on what both see.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/margin.hpp"
#include "program/info/histogram.hpp"
#include "program/info/surface.hpp"

namespace depthgrid::program {

/// Residuals of camera A's points in camera B, over any number of frames.
///
/// Along the ray: e = z of A's point in B minus B's depth at the pixel it falls on. Point to plane: the distance of A's
/// point from the plane through B's point along B's normal, only where both normals agree within 60 degrees.
/// Intrusion: how far A's point stands in front of that plane, in space that B sees free, after the sensor margins of
/// both; 0 where it does not. Only points within 0.3 m of the plane count for it: what is farther is another surface.
struct PairAgreement {
  std::int64_t points = 0;      ///< of A, with a measurement within the depth limit
  std::int64_t pairs = 0;       ///< of these, with a measurement of B where they fall
  std::int64_t consistent = 0;  ///< |e| < 50 mm
  std::int64_t in_front = 0;    ///< e < -100 mm: A sees a surface where B sees through
  std::int64_t behind = 0;      ///< e > 100 mm: hidden from B, as it happens with occlusion
  Histogram along_ray_m;        ///< |e|
  std::int64_t planes = 0;      ///< pairs with normals that agree
  std::int64_t near_plane = 0;  ///< of these, closer than 50 mm
  Histogram to_plane_m;
  Histogram intrusion_m;

  [[nodiscard]] double overlap() const noexcept {
    return points == 0 ? 0.0 : static_cast<double>(pairs) / static_cast<double>(points);
  }
};

/// Adds the points of `a` with depth in (0, limit_m] seen from B. `stride_px`: every n-th pixel of every n-th row.
void add_pair(const Surface& a, const Surface& b, const PinholeCamera& camera_b, const Eigen::Isometry3d& T_b_a,
              double limit_m, int stride_px, const SensorMargin& margin_a, const SensorMargin& margin_b,
              PairAgreement& agreement);

/// The pose margin that this pair suggests: 95 % of A's points then do not stand in space that B frees. NaN: no pairs.
[[nodiscard]] double suggested_pose_margin_m(const PairAgreement& agreement) noexcept;

}  // namespace depthgrid::program
