// The law of repulsion as the mean direction reads it: many times a question, where an exponential each would be what
// takes the time. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "depthgrid/views/settings.hpp"

namespace depthgrid::search {

/// v(D) / V for D from 0 to rho, linear between places so close that it is off by less than a thousandth of itself at
/// the default alpha: pieces of space are coarser than that.
class RepulsionTable {
 public:
  /// From here on for these settings; computes only where they differ from those before.
  void aim(const views::Settings& settings) noexcept;

  /// Distances below 0 count as 0, those above rho as rho.
  [[nodiscard]] double operator()(double distance_m) const noexcept {
    const double at = std::clamp(distance_m * places_per_m_, 0.0, kLast);
    const auto place = static_cast<std::size_t>(at);
    return values_[place] + (at - static_cast<double>(place)) * (values_[place + 1] - values_[place]);
  }

 private:
  static constexpr std::size_t kPlaces = 1024;
  static constexpr double kLast = kPlaces;

  std::array<double, kPlaces + 2> values_{};
  double rho_m_ = 0;
  double alpha_ = 0;
  double places_per_m_ = 0;
};

}  // namespace depthgrid::search
