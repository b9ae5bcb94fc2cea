#include "depthgrid/avoidance/least_padding.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "depthgrid/avoidance/link_scan.hpp"
#include "depthgrid/avoidance/padded_cell.hpp"
#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::avoidance {

namespace {

std::vector<LinkScan> scans_of(const PaddingProblem& problem, const robot::RobotModel& model) {
  std::vector<LinkScan> scans;
  for (std::size_t i = 0; i < problem.asked.size(); ++i) {
    const std::size_t link = problem.asked[i].link;
    if (scans.empty() || scans.back().result.link != link) {
      scans.emplace_back();
      scans.back().result.link = link;
      scans.back().result.name = model.links()[link].name;
    }
    scans.back().asked.push_back(i);
  }
  return scans;
}

/// The layer, of all cells.
double thickest_m(const std::vector<std::vector<Answer>>& answers) {
  double thickest_m = 0;
  for (const std::vector<Answer>& of_cell : answers) {
    thickest_m = thicker(thickest_m, of_cell.front().blind_m);
  }
  return thickest_m;
}

/// What stands behind a reading: what each camera says of its place.
NotClear not_clear(const PaddingProblem& problem, double padding_m, const LinkReading& reading,
                   std::optional<double> next_m) {
  NotClear result{padding_m, reading.cell, reading.answer, false, {}, {}};
  const Proximity& nearest = reading.answer.nearest;
  result.at_the_border = nearest.state == ProximityState::outside || nearest.known_to_m < nearest.distance_m;
  if (result.at_the_border || !nearest.nearest_world.allFinite()) {
    return result;
  }
  PaddedCell now(problem, padding_m);
  for (std::size_t k = 0; k < problem.rig.cameras.size(); ++k) {
    result.cameras.push_back(now.alone(reading.cell, k, nearest.nearest_world).says);
  }
  double most_m = 0;
  if (next_m) {
    PaddedCell next(problem, *next_m);
    for (std::size_t k = 0; k < problem.rig.cameras.size(); ++k) {
      const double around_m = next.alone(reading.cell, k, nearest.nearest_world).around_m;
      if (around_m > most_m) {
        most_m = around_m;
        result.decides = k;
      }
    }
  }
  return result;
}

/// The padding that clears all that any clears, and who decides it.
void decide(const std::vector<LinkScan>& scans, LeastPadding& found) {
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::optional<double>& least_m = scans[i].result.least_m;
    if (least_m && (!found.decides || *least_m > *scans[*found.decides].result.least_m)) {
      found.decides = i;
    }
  }
  if (!found.decides) {
    return;
  }
  const double most_m = *scans[*found.decides].result.least_m;
  const bool clears_all = std::all_of(scans.begin(), scans.end(), [&](const LinkScan& scan) {
    return !scan.result.least_m || scan.result.clear_to_m >= most_m;
  });
  found.padding_m = clears_all ? std::optional(most_m) : std::nullopt;
}

}  // namespace

LeastPadding least_padding(const Rig& rig, const robot::RobotModel& model, std::span<const EmptyCell> cells,
                           const LeastPaddingSettings& settings) {
  const PaddingProblem problem = padding_problem(rig, model, cells, settings);
  views::validate(settings.search, problem.rig);
  const std::vector<double>& paddings_m = settings.paddings_m;
  LeastPadding found;
  double motion_m = 0;
  for (const EmptyCell& cell : cells) {
    motion_m = std::accumulate(cell.motion_m.begin(), cell.motion_m.end(), motion_m,
                               [](double a, double b) { return std::max(a, b); });
  }
  found.robot_within_m = settings.robot_within_m.value_or(
      motion_m + robot_within_m(problem.rig, settings.search, reach_m(problem, paddings_m.front())));
  std::vector<LinkScan> scans = scans_of(problem, model);
  for (std::size_t p = 0; p < paddings_m.size(); ++p) {
    const std::vector<std::vector<Answer>> answers = answers_with(problem, paddings_m[p]);
    const double blind_m = thickest_m(answers);
    if (p == 0 && !(blind_m <= found.robot_within_m)) {
      fail("least padding: the smallest padding tested, ", paddings_m[p], " m, makes a layer of ", blind_m,
           " m, and what is farther than ", found.robot_within_m,
           " m from a link is no part of the robot: test smaller ones, or state robot_within_m");
    }
    bool all_told = true;
    for (LinkScan& scan : scans) {
      if (!scan.is_told) {
        look(scan, p, readings_of(scan, problem, answers), settings, found.robot_within_m, blind_m);
      }
      all_told = all_told && (scan.is_told || scan.result.least_m);
    }
    if (all_told) {
      break;  // a thicker layer hides more and clears no other link
    }
  }
  decide(scans, found);
  if (found.padding_m) {
    found.blind_m = thickest_m(answers_with(problem, *found.padding_m));
  }
  for (LinkScan& scan : scans) {
    if (scan.before) {
      scan.result.before = not_clear(problem, paddings_m[*scan.before], scan.worst_before, scan.result.least_m);
    }
    if (scan.has_ended && !found.padding_m) {
      const auto end = std::upper_bound(paddings_m.begin(), paddings_m.end(), scan.result.clear_to_m);
      scan.result.after = not_clear(problem, *end, scan.worst_after, {});
    }
    found.links.push_back(std::move(scan.result));
  }
  return found;
}

}  // namespace depthgrid::avoidance
