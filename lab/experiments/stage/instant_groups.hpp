// Answers at many instants in two groups: the instants that an experiment is about, and all others.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "lab/experiments/experiment.hpp"
#include "lab/experiments/stage/deviation_table.hpp"
#include "lab/experiments/stage/method_comparison.hpp"
#include "lab/experiments/stage/staged_cell.hpp"

namespace depthgrid::experiments {

/// One row a candidate each, in the candidates' order.
struct GroupedDeviations {
  std::vector<LabelledDeviation> chosen;  ///< instants that the experiment is about
  std::vector<LabelledDeviation> otherwise;
  double person_to_arm_m = std::numeric_limits<double>::infinity();  ///< smallest real distance of all instants
};

struct GroupedInstants {
  GroupedDeviations figures;
  std::vector<Instant> instants;
};

/// The middles of so many equal parts of a time.
struct InstantSeries {
  double begin_s = 0;
  double end_s = 0;
  int count = 0;
};

/// What candidates that remember see between instants: images at 30 Hz, from a second before the first on. Where none
/// remembers it does nothing.
class FramesBetween {
 public:
  using Move = void (StagedCell::*)(double time_s);
  /// All must outlive it. `move` takes the stage to a time.
  FramesBetween(StagedCell& stage, MethodComparison& comparison, Move move, double first_instant_s);

  /// Up to an instant at which the candidates are asked next. The stage does not stand there yet.
  void play_until(double instant_s);

 private:
  StagedCell& stage_;
  MethodComparison& comparison_;
  Move move_;
  double next_s_;
  std::uint64_t passed_ = 0;
};

/// Rows without answers, and the answers of an instant to them; metres up to the letter's rho.
[[nodiscard]] std::vector<LabelledDeviation> empty_rows(const std::vector<Candidate>& candidates);
void add_answers(const Instant& instant, std::vector<LabelledDeviation>& rows);

/// Takes the stage to one instant after the other with `move` (all of it, or the person alone) and asks all candidates.
/// FramesBetween() are played.
/// Throws Error as MethodComparison does.
[[nodiscard]] GroupedInstants measure_groups(StagedCell& stage, MethodComparison& comparison,
                                             const InstantSeries& series, void (StagedCell::*move)(double time_s),
                                             bool (*is_chosen)(const Instant& instant), const Progress& progress);

/// Both tables, under `chosen_heading` and "At all other instants:", and their figures, those of the chosen instants as
/// `chosen_key`.
void report_groups(const GroupedDeviations& groups, std::string_view chosen_heading, const std::string& chosen_key,
                   ExperimentReport& report);

}  // namespace depthgrid::experiments
