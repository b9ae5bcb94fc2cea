#include "lab/experiments/stage/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/statistics.hpp"

namespace depthgrid::experiments {

void Deviation::leave_out() { ++not_compared_; }

void Deviation::add(const Proximity& answer, double true_m) {
  const double truth_m = std::min(true_m, rho_m_);
  const bool border_nearer = std::isfinite(answer.known_to_m) && answer.known_to_m < truth_m;
  if (!has_distance(answer) || border_nearer) {
    ++not_compared_;
    return;
  }
  short_m_.push_back(truth_m - std::min(answer.distance_m, rho_m_));
}

double Deviation::share(double beyond_m, bool too_far) const {
  if (short_m_.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto counts = [&](double short_m) { return too_far ? -short_m > beyond_m : short_m > beyond_m; };
  return static_cast<double>(std::count_if(short_m_.begin(), short_m_.end(), counts)) /
         static_cast<double>(short_m_.size());
}

double Deviation::false_obstacles() const { return share(kFalseObstacle, false); }

double Deviation::overestimates() const { return share(kOverestimate, true); }

double Deviation::largest_overestimate_m() const {
  return short_m_.empty() ? std::numeric_limits<double>::quiet_NaN()
                          : std::max(0.0, -*std::min_element(short_m_.begin(), short_m_.end()));
}

double Deviation::shortfall_m(double q) const { return report::quantile(short_m_, q); }

nlohmann::ordered_json Deviation::json() const {
  nlohmann::ordered_json json;
  json["answers"] = compared();
  json["not_compared"] = not_compared();
  json["false_obstacle_share"] = false_obstacles();
  json["shortfall_median_m"] = shortfall_m(0.5);
  json["shortfall_95_m"] = shortfall_m(0.95);
  json["overestimate_share"] = overestimates();
  json["overestimate_largest_m"] = largest_overestimate_m();
  return json;
}

}  // namespace depthgrid::experiments
