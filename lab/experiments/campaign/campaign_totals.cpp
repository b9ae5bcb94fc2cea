#include "lab/experiments/campaign/campaign_totals.hpp"

#include <algorithm>
#include <limits>

#include "lab/experiments/campaign/campaign_motions.hpp"

namespace depthgrid::experiments {

MethodTotals totals(const CampaignState& state, Method method, double duration_s) {
  MethodTotals sum;
  std::vector<double> smallest_m;
  double share = 0;
  for (const auto& [number, outcome] : state.motions) {
    const RunSummary& run = outcome.runs.at(method);
    ++sum.motions;
    sum.with_contact += run.contacts.empty() ? 0 : 1;
    sum.contacts += static_cast<int>(run.contacts.size());
    for (const Contact& contact : run.contacts) {
      ++sum.causes[contact.cause];
      sum.worst_robot_m_s = std::max(sum.worst_robot_m_s, contact.robot_m_s);
      sum.worst_during_m_s = std::max(sum.worst_during_m_s, contact.fastest_during_m_s.value_or(0));
    }
    sum.object_contacts += run.object_contacts;
    smallest_m.push_back(run.smallest_person_m);
    share += run.task_share;
    sum.in_contact_s += run.in_contact_s;
    sum.stopped_share += run.stopped_s;
    sum.false_stop_share += run.false_stop_s;
    sum.over_estimates += run.over_estimates;
    sum.largest_over_estimate_m = std::max(sum.largest_over_estimate_m, run.largest_over_estimate_m);
    sum.compared += run.compared;
  }
  if (sum.motions > 0) {
    const double time_s = duration_s * sum.motions;
    std::sort(smallest_m.begin(), smallest_m.end());
    sum.smallest_m = smallest_m.front();
    sum.median_smallest_m = smallest_m[smallest_m.size() / 2];
    sum.s_per_vertex = time_s / share;
    sum.stopped_share /= time_s;
    sum.false_stop_share /= time_s;
  }
  return sum;
}

TimeBesideLetter time_beside_letter(const CampaignState& state, Method method, Motions which) {
  TimeBesideLetter result;
  double share = 0;
  double letter_share = 0;
  for (const auto& [number, outcome] : state.motions) {
    if (which != Motions::all && is_recorded(outcome.name) != (which == Motions::recordings)) {
      continue;
    }
    const double own = outcome.runs.at(method).task_share;
    const double letter = outcome.runs.at(Method::letter_two).task_share;
    ++result.motions;
    share += own;
    letter_share += letter;
    result.above_wanted += letter > kSlowest * own ? 1 : 0;
    result.below_one_vertex += own < 1 ? 1 : 0;
    result.letter_below_vertex += letter < 1 ? 1 : 0;
  }
  result.ratio = share > 0 ? letter_share / share : std::numeric_limits<double>::infinity();
  return result;
}

std::vector<Contact> contacts_caused(const CampaignState& state, Method method) {
  std::vector<Contact> caused;
  for (const auto& [number, outcome] : state.motions) {
    for (const Contact& contact : outcome.runs.at(method).contacts) {
      if (caused_by_the_robot(contact.cause)) {
        caused.push_back(contact);
      }
    }
  }
  return caused;
}

}  // namespace depthgrid::experiments
