// A pixel's pyramid between two depths, in its camera's frame: what the sets of the oracle are made of.
#pragma once

#include <Eigen/Core>

namespace depthgrid::reference {

/// { a0 z <= x <= a1 z, b0 z <= y <= b1 z, d1 <= z <= d2 }, convex. 0 <= d1; d2 may be infinite.
struct PyramidPiece {
  double a0, a1, b0, b1, d1_m, d2_m;

  /// The piece's point nearest to p.
  [[nodiscard]] Eigen::Vector3d nearest_to(const Eigen::Vector3d& p) const;
  [[nodiscard]] bool meets_ball(const Eigen::Vector3d& p, double radius_m) const {
    return (nearest_to(p) - p).squaredNorm() <= radius_m * radius_m;
  }
  /// Largest value of direction . y over the piece, which has to end (finite d2).
  [[nodiscard]] double support(const Eigen::Vector3d& direction) const;
};

/// Distance between a segment and a piece.
struct Separation {
  double lower_m;           ///< proven by a plane between the two
  Eigen::Vector3d nearest;  ///< the piece's point that was found nearest
};

/// Between the segment from a to b and a piece with finite d2. Stops as soon as lower_m reaches `enough_m` or is within
/// 1e-7 m of the distance.
[[nodiscard]] Separation separation(const PyramidPiece& piece, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    double enough_m);

}  // namespace depthgrid::reference
