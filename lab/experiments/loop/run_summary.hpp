// What is kept of one run of the avoidance loop.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "lab/experiments/loop/contact.hpp"

namespace depthgrid::experiments {

struct RunSummary {
  double task_share = 0;  ///< vertices reached, with the way to the next one, as a share of an edge each
  double smallest_person_m = std::numeric_limits<double>::infinity();  ///< infinity with nobody
  double in_contact_s = 0;                                             ///< with the person
  double stopped_s = 0;  ///< the end effector slower than a tenth of the task's speed, for any reason
  /// As slow while nothing (person, table, plate) was really within rho of the moving links.
  double false_stop_s = 0;
  /// Periods in which the search was asked about the link that was nearest to the person, who was within rho; and those
  /// of them in which it held that link for farther away than it was, by more than 1 cm.
  std::int64_t compared = 0;
  std::int64_t over_estimates = 0;
  double largest_over_estimate_m = 0;
  int object_contacts = 0;          ///< with plates, table, workpiece
  std::vector<Contact> contacts{};  ///< with the person: each from touching until 2 cm apart again
};

}  // namespace depthgrid::experiments
