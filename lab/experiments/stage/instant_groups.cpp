#include "lab/experiments/stage/instant_groups.hpp"

#include <algorithm>

#include "lab/experiments/experiment_report.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kFramePeriod_s = 1.0 / 30;
constexpr double kSeenBefore_s = 1;
constexpr std::uint64_t kPassedFrom = 1'000'000;  // the noise of images between instants is numbered from here

}  // namespace

FramesBetween::FramesBetween(StagedCell& stage, MethodComparison& comparison, Move move, double first_instant_s)
    : stage_(stage), comparison_(comparison), move_(move), next_s_(first_instant_s - kSeenBefore_s) {}

void FramesBetween::play_until(double instant_s) {
  while (comparison_.remembers() && next_s_ < instant_s - 0.5 * kFramePeriod_s) {
    (stage_.*move_)(next_s_);
    comparison_.pass(stage_, next_s_, kPassedFrom + passed_++);
    next_s_ += kFramePeriod_s;
  }
  next_s_ = instant_s + kFramePeriod_s;
}

std::vector<LabelledDeviation> empty_rows(const std::vector<Candidate>& candidates) {
  std::vector<LabelledDeviation> rows;
  rows.reserve(candidates.size());
  for (const Candidate& candidate : candidates) {
    rows.push_back({candidate.label, Deviation(DistanceMethod::kRho)});
  }
  return rows;
}

void add_answers(const Instant& instant, std::vector<LabelledDeviation>& rows) {
  for (std::size_t c = 0; c < rows.size(); ++c) {
    for (std::size_t i = 0; i < instant.truth.size(); ++i) {
      rows[c].deviation.add(instant.answers[c][i], instant.truth[i].distance_m);
    }
  }
}

GroupedInstants measure_groups(StagedCell& stage, MethodComparison& comparison, const InstantSeries& series,
                               void (StagedCell::*move)(double time_s), bool (*is_chosen)(const Instant& instant),
                               const Progress& progress) {
  GroupedInstants result;
  GroupedDeviations& figures = result.figures;
  figures.chosen = empty_rows(comparison.candidates());
  figures.otherwise = figures.chosen;
  const auto time_of = [&](int number) {
    return series.begin_s + (series.end_s - series.begin_s) * (number + 0.5) / series.count;
  };
  FramesBetween between(stage, comparison, move, time_of(0));
  for (int number = 0; number < series.count; ++number) {
    const double time_s = time_of(number);
    between.play_until(time_s);
    (stage.*move)(time_s);
    const Instant& instant =
        result.instants.emplace_back(comparison.at(stage, time_s, static_cast<std::uint64_t>(number)));
    figures.person_to_arm_m = std::min(figures.person_to_arm_m, instant.person_to_arm_m);
    add_answers(instant, is_chosen(instant) ? figures.chosen : figures.otherwise);
    progress(static_cast<std::size_t>(number) + 1, static_cast<std::size_t>(series.count));
  }
  return result;
}

void report_groups(const GroupedDeviations& groups, std::string_view chosen_heading, const std::string& chosen_key,
                   ExperimentReport& report) {
  report.paragraph(chosen_heading);
  report.paragraph(deviation_table(groups.chosen));
  report.paragraph("At all other instants:");
  report.paragraph(deviation_table(groups.otherwise));
  report.figures()["person_to_arm_smallest_m"] = groups.person_to_arm_m;
  report.figures()[chosen_key] = deviation_figures(groups.chosen);
  report.figures()["otherwise"] = deviation_figures(groups.otherwise);
}

}  // namespace depthgrid::experiments
