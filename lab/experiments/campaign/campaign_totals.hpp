// The campaign's motions summed up.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "lab/experiments/campaign/campaign_state.hpp"

namespace depthgrid::experiments {

struct MethodTotals {
  int motions = 0;
  int with_contact = 0;  ///< motions
  int contacts = 0;
  std::map<ContactCause, int> causes;
  double smallest_m = 0;
  double median_smallest_m = 0;  ///< of the motions' smallest distances
  double s_per_vertex = 0;
  double worst_robot_m_s = 0;   ///< fastest that a touched point came towards the person; 0 without contact
  double worst_during_m_s = 0;  ///< the same while contacts lasted
  int object_contacts = 0;
  double in_contact_s = 0;
  double stopped_share = 0;
  double false_stop_share = 0;
  std::int64_t over_estimates = 0;
  double largest_over_estimate_m = 0;
  std::int64_t compared = 0;
};

[[nodiscard]] MethodTotals totals(const CampaignState& state, Method method, double duration_s);

/// Task time of a method beside the letter's with two cameras.
struct TimeBesideLetter {
  int motions = 0;
  double ratio = 0;             ///< of all of them together; infinity when the method does nothing
  int above_wanted = 0;         ///< motions that took more than kSlowest times as long
  int below_one_vertex = 0;     ///< motions in which the method did less than one edge
  int letter_below_vertex = 0;  ///< the same of the letter's
};
inline constexpr double kSlowest = 1.5;

enum class Motions : std::uint8_t { all, scripts, recordings };
[[nodiscard]] TimeBesideLetter time_beside_letter(const CampaignState& state, Method method, Motions which);

/// The contacts of a method that were caused_by_the_robot().
[[nodiscard]] std::vector<Contact> contacts_caused(const CampaignState& state, Method method);

}  // namespace depthgrid::experiments
