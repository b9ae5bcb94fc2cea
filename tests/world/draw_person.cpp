#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "world/draw.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

/// Bars that hang down and swing forward and back, one below the other; together no faster than speed_m_s.
class Limb {
 public:
  Limb(Random& random, const Vector3d& forward, double speed_m_s, int parts)
      : random_(random), forward_(forward), speed_m_s_(speed_m_s / parts) {}

  void grow(Place& place, double length_m, double rest_rad) const {
    Bar bar;
    bar.length_m = length_m;
    bar.u = -Vector3d::UnitZ();
    bar.w = forward_;
    bar.rest_rad = rest_rad;
    bar.swing_rad = random_.uniform(0.1, 0.7);
    bar.rate_rad_s = speed_m_s_ / (length_m * bar.swing_rad);
    bar.phase_rad = random_.uniform(0, 2 * std::numbers::pi);
    place.bars.push_back(bar);
  }

 private:
  Random& random_;
  Vector3d forward_;
  double speed_m_s_;
};

}  // namespace

std::vector<Solid> random_person(Random& random, std::shared_ptr<const Path> feet, double path_speed_m_s,
                                 double speed_m_s, double least_radius_m) {
  const double heading = random.uniform(0, 2 * std::numbers::pi);
  const Vector3d forward(std::cos(heading), std::sin(heading), 0);
  const Vector3d side = Vector3d::UnitZ().cross(forward);
  const double size = random.uniform(0.85, 1.1);
  const double swing_m_s = 0.999 * (speed_m_s - path_speed_m_s);
  std::vector<Solid> person;
  person.reserve(12);
  const auto add = [&](const Place& a, const Place& b, double radius_m) {
    person.push_back({a, b, std::max(least_radius_m, radius_m * size)});
  };
  const auto fixed = [&](double across_m, double up_m) {
    return Place{feet, size * (across_m * side + up_m * Vector3d::UnitZ())};
  };
  add(fixed(0, 0.95), fixed(0, 1.35), 0.13);
  add(fixed(0, 1.58), fixed(0, 1.65), 0.1);
  for (const double left : {-1.0, 1.0}) {
    const double lifted = random.uniform(0, 1.6);
    const Limb arm(random, forward, swing_m_s, 3);
    Place end = fixed(left * 0.2, 1.38);
    Place begin = end;
    for (const auto& [length_m, rest_rad, radius_m] :
         {std::array{0.3, lifted, 0.05}, std::array{0.26, 1.2 * lifted, 0.045}, std::array{0.1, 1.2 * lifted, 0.04}}) {
      begin = end;
      arm.grow(end, size * length_m, rest_rad);
      add(begin, end, radius_m);
    }
    const Limb leg(random, forward, swing_m_s, 2);
    end = fixed(left * 0.1, 0.9);
    for (const auto& [length_m, rest_rad, radius_m] : {std::array{0.43, 0.1, 0.075}, std::array{0.43, -0.1, 0.06}}) {
      begin = end;
      leg.grow(end, size * length_m, rest_rad);
      add(begin, end, radius_m);
    }
  }
  return person;
}

}  // namespace depthgrid::world
