#include "world/motion.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::world {

Eigen::Vector3d Path::at(double time_s) const {
  const auto after = std::upper_bound(stops_.begin(), stops_.end(), time_s,
                                      [](double time, const Stop& stop) { return time < stop.time_s; });
  if (after == stops_.begin()) {
    return stops_.front().at_world;
  }
  if (after == stops_.end()) {
    return stops_.back().at_world;
  }
  const Stop& before = *(after - 1);
  const double part = (time_s - before.time_s) / (after->time_s - before.time_s);
  return before.at_world + part * (after->at_world - before.at_world);
}

Eigen::Vector3d Bar::at(double time_s) const {
  const double angle = rest_rad + swing_rad * std::sin(rate_rad_s * time_s + phase_rad);
  return length_m * (std::cos(angle) * u + std::sin(angle) * w);
}

Eigen::Vector3d Place::at(double time_s) const {
  Eigen::Vector3d place = path->at(time_s) + offset;
  for (const Bar& bar : bars) {
    place += bar.at(time_s);
  }
  return place;
}

}  // namespace depthgrid::world
