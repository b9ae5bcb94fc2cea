#include "depthgrid/avoidance/link_scan.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"

namespace depthgrid::avoidance {

namespace {

/// Up to where nothing is known to stand at a link: a distance within the layer says nothing.
double unknown_from_m(const Answer& answer) noexcept {
  return has_distance(answer.nearest) ? std::max(answer.nearest.distance_m, answer.blind_m) : answer.blind_m;
}

bool covers(const LinkScan& scan, double robot_within_m, double blind_m) {
  return std::any_of(scan.unknown_from_m.begin(), scan.unknown_from_m.end(),
                     [&](double u_m) { return u_m > robot_within_m && u_m <= blind_m; });
}

}  // namespace

std::vector<LinkReading> readings_of(const LinkScan& scan, const PaddingProblem& problem,
                                     const std::vector<std::vector<Answer>>& answers) {
  std::vector<LinkReading> readings;
  for (std::size_t cell = 0; cell < answers.size(); ++cell) {
    LinkReading reading{cell + problem.settings.warm_up, answers[cell][scan.asked.front()]};
    for (const std::size_t capsule : scan.asked) {
      const LinkReading other{reading.cell, answers[cell][capsule]};
      reading = other.left_m() < reading.left_m() ? other : reading;
    }
    const Proximity& nearest = reading.answer.nearest;
    if (nearest.state == ProximityState::beyond_rho &&
        nearest.distance_m - reading.answer.blind_m < problem.settings.clearance_m) {
      fail("least padding: nothing is within rho_m = ", nearest.distance_m, " m, and the layer is ",
           reading.answer.blind_m, " m thick: rho_m must be at least ",
           reading.answer.blind_m + problem.settings.clearance_m, " m, that and the clearance");
    }
    readings.push_back(reading);
  }
  return readings;
}

void look(LinkScan& scan, std::size_t padding, const std::vector<LinkReading>& readings,
          const LeastPaddingSettings& settings, double robot_within_m, double blind_m) {
  const double padding_m = settings.paddings_m[padding];
  const LinkReading& worst =
      *std::min_element(readings.begin(), readings.end(),
                        [](const LinkReading& a, const LinkReading& b) { return a.left_m() < b.left_m(); });
  LinkPadding& result = scan.result;
  result.tested_to_m = padding_m;
  const bool has_enough = worst.left_m() >= settings.clearance_m;
  if (has_enough && (result.least_m || !covers(scan, robot_within_m, blind_m))) {
    result.least_m = result.least_m.value_or(padding_m);
    result.clear_to_m = padding_m;
    return;
  }
  if (result.least_m) {
    scan.has_ended = true;
    scan.is_told = true;
    scan.worst_after = worst;
    return;
  }
  if (!has_enough) {
    scan.before = padding;
    scan.worst_before = worst;
    for (const LinkReading& reading : readings) {
      if (!(reading.left_m() >= settings.clearance_m)) {
        scan.unknown_from_m.push_back(unknown_from_m(reading.answer));
      }
    }
  }
  // All thicker layers cover that, too.
  if (covers(scan, robot_within_m, blind_m)) {
    result.covers_from_m = padding_m;
    scan.is_told = true;
  }
}

}  // namespace depthgrid::avoidance
