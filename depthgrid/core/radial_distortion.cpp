#include "depthgrid/core/radial_distortion.hpp"

#include <cmath>

namespace depthgrid {
namespace {

/// Steps in which the radial function is checked for a fold.
constexpr int kFoldSteps = 4096;

/// Polynomial over polynomial: plumb_bob has the denominator 1.
template <class T>
Radial<T> rational(const Distortion& distortion, const T& s) noexcept {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = distortion.coefficients;
  const T numerator = T(1.0) + s * (T(k1) + s * (T(k2) + s * T(k3)));
  const T numerator_1 = T(k1) + s * (T(2.0 * k2) + s * T(3.0 * k3));
  const T numerator_2 = T(2.0 * k2) + s * T(6.0 * k3);
  const T denominator = T(1.0) + s * (T(k4) + s * (T(k5) + s * T(k6)));
  const T denominator_1 = T(k4) + s * (T(2.0 * k5) + s * T(3.0 * k6));
  const T denominator_2 = T(2.0 * k5) + s * T(6.0 * k6);
  const T factor = numerator / denominator;
  const T derivative = (numerator_1 - factor * denominator_1) / denominator;
  const T second = (numerator_2 - T(2.0) * derivative * denominator_1 - factor * denominator_2) / denominator;
  return {factor, derivative, second, denominator};
}

/// a(s) = atan(r) / r and its derivatives with respect to s = r^2. Each is the integral over t in [0, 1] of a power of
/// 1 / (1 + s t^2), so |a|, |a'| and |a''| fall with s and neither changes its sign.
struct Arc {
  double a, a_1, a_2;
};

Arc arc(double s) noexcept {
  constexpr double kSmall = 0.05;  // the closed form loses digits towards s = 0
  if (s < kSmall) {
    Arc sum{0.0, 0.0, 0.0};
    for (int n = 16; n >= 0; --n) {  // Horner's rule for a = 1 - s/3 + s^2/5 - ...
      const double coefficient = (n % 2 == 0 ? 1.0 : -1.0) / (2.0 * n + 1.0);
      sum.a_2 = sum.a_2 * s + 2.0 * sum.a_1;
      sum.a_1 = sum.a_1 * s + sum.a;
      sum.a = sum.a * s + coefficient;
    }
    return sum;
  }
  const double r = std::sqrt(s);
  const double a = std::atan(r) / r;
  const double a_1 = (1.0 / (1.0 + s) - a) / (2.0 * s);
  const double a_2 = (-1.0 / square(1.0 + s) - 3.0 * a_1) / (2.0 * s);
  return {a, a_1, a_2};
}

/// theta^2 as a function of s, with its derivatives: u = s a^2, u' = a / (1 + s).
struct Angle {
  double u, u_1, u_2;
};

Angle angle(double s, const Arc& of_s) noexcept {
  const double inverse = 1.0 / (1.0 + s);
  return {s * square(of_s.a), of_s.a * inverse, inverse * (of_s.a_1 - of_s.a * inverse)};
}

/// The polynomial theta_d / theta in u = theta^2 times theta / r.
template <class T>
Radial<T> equidistant(const Distortion& distortion, const T& a, const T& a_1, const T& a_2, const T& u, const T& u_1,
                      const T& u_2) noexcept {
  const auto& k = distortion.coefficients;
  const T p = T(1.0) + u * (T(k[0]) + u * (T(k[1]) + u * (T(k[2]) + u * T(k[3]))));
  const T p_1 = T(k[0]) + u * (T(2.0 * k[1]) + u * (T(3.0 * k[2]) + u * T(4.0 * k[3])));
  const T p_2 = T(2.0 * k[1]) + u * (T(6.0 * k[2]) + u * T(12.0 * k[3]));
  return {a * p, a_1 * p + a * p_1 * u_1, a_2 * p + T(2.0) * a_1 * p_1 * u_1 + a * (p_2 * square(u_1) + p_1 * u_2),
          T(1.0)};
}

/// Every function of s in it is monotone, so the ends of s give its range.
Radial<Interval> equidistant_over(const Distortion& distortion, const Interval& s) noexcept {
  const Arc low = arc(s.low);
  const Arc high = arc(s.high);
  const Angle u_low = angle(s.low, low);
  const Angle u_high = angle(s.high, high);
  return equidistant<Interval>(distortion, {high.a, low.a}, {low.a_1, high.a_1}, {high.a_2, low.a_2},
                               {u_low.u, u_high.u}, {u_high.u_1, u_low.u_1}, {u_low.u_2, u_high.u_2});
}

}  // namespace

Radial<double> radial(const Distortion& distortion, double s) noexcept {
  if (distortion.model == Distortion::Model::equidistant) {
    const Arc of_s = arc(s);
    const Angle u = angle(s, of_s);
    return equidistant<double>(distortion, of_s.a, of_s.a_1, of_s.a_2, u.u, u.u_1, u.u_2);
  }
  return rational<double>(distortion, s);
}

/// The mean value form (value in the middle plus derivative times half the width) stays tight where large coefficients
/// nearly cancel, which plain interval arithmetic does not.
Radial<Interval> radial_over(const Distortion& distortion, const Interval& s) noexcept {
  const Radial<double> middle = radial(distortion, 0.5 * (s.low + s.high));
  Radial<Interval> all = distortion.model == Distortion::Model::equidistant ? equidistant_over(distortion, s)
                                                                            : rational<Interval>(distortion, s);
  const Interval offset(-0.5 * (s.high - s.low), 0.5 * (s.high - s.low));
  all.derivative = Interval(middle.derivative) + all.second_derivative * offset;
  all.factor = Interval(middle.factor) + all.derivative * offset;
  return all;
}

Tangential tangential(const Distortion& distortion) noexcept {
  if (distortion.model == Distortion::Model::equidistant) {
    return {0.0, 0.0};
  }
  return {distortion.coefficients[2], distortion.coefficients[3]};
}

double unfolded_squared_radius(const Distortion& distortion, double s_largest) noexcept {
  for (int step = 0; step < kFoldSteps; ++step) {
    const Interval s(s_largest * step / kFoldSteps, s_largest * (step + 1) / kFoldSteps);
    const Radial<Interval> r = radial_over(distortion, s);
    if (!((r.factor + Interval(2.0) * s * r.derivative).low > 0.0)) {
      return s.low;
    }
  }
  return s_largest;
}

}  // namespace depthgrid
