// A hand near a link, and what rules for the robot's own pixels make of it: deleted by distance, masked, or removed as
// here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/experiments/blind_layer/hand_beside.hpp"
#include "lab/experiments/experiment.hpp"

namespace depthgrid::experiments {

enum class SelfFilter : std::uint8_t {
  deleted,  ///< pixels that lie within a distance of the robot's model are taken out; what nobody sees counts as free
  masked,   ///< so are all pixels in which the padded robot would stand, whatever they read
  removed,  ///< this project's removal with that padding, and the search: what nobody sees counts as obstacle
};

struct FilterRule {
  std::string label;
  SelfFilter filter = SelfFilter::deleted;
  double distance_m = 0;  ///< the rule's one number
};
[[nodiscard]] const std::vector<FilterRule>& filter_rules();

/// What a rule answers for the last link with the hand at a distance; kFarthest_m where nothing is nearer.
struct FilterReading {
  double gap_m = 0;         ///< the truth
  double to_robot_m = 0;    ///< from the hand to the nearest of all links, which blind_m is about
  double distance_m = 0;    ///< the answer
  double blind_m = 0;       ///< of our own answers; 0 for the others, which have none
  std::size_t hand_px = 0;  ///< pixels of the hand that are left in all images
};

inline constexpr double kFarthest_m = 0.6;

/// One rule and place, the gap from 0 to 0.4 m.
struct FilterSweep {
  std::size_t rule = 0;
  HandPlace place = HandPlace::beside;
  std::vector<FilterReading> readings;

  /// The largest gap at which no pixel of the hand is left; at which the answer is too far by more than 1 cm.
  [[nodiscard]] std::optional<double> gone_to_m() const;
  [[nodiscard]] std::optional<double> too_far_to_m() const;
  /// The same that blind_m does not cover.
  [[nodiscard]] std::optional<double> unsaid_to_m() const;
  [[nodiscard]] double most_too_far_m() const;
};

/// Ideal sensor. Throws Error. `pictures` may be null.
[[nodiscard]] std::vector<FilterSweep> measure_self_filter(const Options& options, ExperimentReport* pictures);

void run_self_filter(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
