// How far answers are from the truth.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "depthgrid/core/proximity.hpp"

namespace depthgrid::experiments {

/// Collects answers beside the true distances, both cut off at rho. Where the border of the space of interest is
/// nearer than the truth nothing is compared: an obstacle outside is not the method's to find.
class Deviation {
 public:
  static constexpr double kFalseObstacle = 0.10;  ///< metres too near: nothing there but unseen space
  static constexpr double kOverestimate = 0.01;   ///< metres too far: one cell of the letter's grid

  explicit Deviation(double rho_m) : rho_m_(rho_m) {}

  void add(const Proximity& answer, double true_m);
  /// An answer that is not compared, because something stands where no method can see it: inside the robot's padding.
  void leave_out();

  [[nodiscard]] std::size_t compared() const noexcept { return short_m_.size(); }
  [[nodiscard]] std::size_t not_compared() const noexcept { return not_compared_; }
  /// Share of the compared answers that are more than kFalseObstacle too near.
  [[nodiscard]] double false_obstacles() const;
  /// Share that is more than kOverestimate too far.
  [[nodiscard]] double overestimates() const;
  [[nodiscard]] double largest_overestimate_m() const;
  /// The truth less the answer below which the share q of the values lies.
  [[nodiscard]] double shortfall_m(double q) const;

  /// All of this, units in the names.
  [[nodiscard]] nlohmann::ordered_json json() const;

 private:
  [[nodiscard]] double share(double beyond_m, bool too_far) const;

  double rho_m_;
  std::vector<double> short_m_;  ///< truth less answer; negative: too far
  std::size_t not_compared_ = 0;
};

}  // namespace depthgrid::experiments
