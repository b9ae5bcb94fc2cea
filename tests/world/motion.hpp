// Motion with a bound of its speed that holds exactly, for every pair of times.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace depthgrid::world {

/// A way through stops, straight and at even speed between two of them. It stands before the first and after the last.
class Path {
 public:
  struct Stop {
    double time_s;
    Eigen::Vector3d at_world;
  };
  /// At least one stop, times ascending.
  explicit Path(std::vector<Stop> stops) : stops_(std::move(stops)) {}

  [[nodiscard]] Eigen::Vector3d at(double time_s) const;

 private:
  std::vector<Stop> stops_;
};

/// A bar that swings in a plane about its beginning: its end is length_m (cos(angle) u + sin(angle) w) away, with
/// angle = rest + swing sin(rate t + phase). Its end is no faster than length swing rate relative to its beginning.
struct Bar {
  double length_m = 0;
  Eigen::Vector3d u = Eigen::Vector3d::UnitX();  ///< u and w: unit and perpendicular
  Eigen::Vector3d w = Eigen::Vector3d::UnitZ();
  double rest_rad = 0;
  double swing_rad = 0;
  double rate_rad_s = 0;
  double phase_rad = 0;

  [[nodiscard]] Eigen::Vector3d at(double time_s) const;
  [[nodiscard]] double speed_m_s() const { return length_m * swing_rad * rate_rad_s; }
};

/// A place that moves: bars, one at the end of the other, carried along a path. No faster than path and bars together.
struct Place {
  std::shared_ptr<const Path> path;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::vector<Bar> bars{};

  [[nodiscard]] Eigen::Vector3d at(double time_s) const;
};

}  // namespace depthgrid::world
