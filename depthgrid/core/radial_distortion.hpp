// The radial part of the distortion models: by what a lens multiplies the distance of a ray from the axis. Internal.
#pragma once

#include "depthgrid/core/distortion.hpp"
#include "depthgrid/core/interval.hpp"

namespace depthgrid {

/// The factor on the radius r = |(x/z, y/z)| and its derivatives with respect to s = r^2. T is double or Interval. The
/// model is not finite where the denominator vanishes.
template <class T>
struct Radial {
  T factor, derivative, second_derivative, denominator;
};

[[nodiscard]] Radial<double> radial(const Distortion& distortion, double s) noexcept;

/// Encloses the radial function over s.
[[nodiscard]] Radial<Interval> radial_over(const Distortion& distortion, const Interval& s) noexcept;

/// p1 and p2 of the models that have them, else 0.
struct Tangential {
  double p1, p2;
};

[[nodiscard]] Tangential tangential(const Distortion& distortion) noexcept;

/// The squared radius up to which the radial function r R(r^2) surely grows, at most s_largest. Beyond a fold the model
/// maps points that the lens never images back into the picture.
[[nodiscard]] double unfolded_squared_radius(const Distortion& distortion, double s_largest) noexcept;

}  // namespace depthgrid
