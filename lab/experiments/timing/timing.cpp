#include "lab/experiments/timing/timing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/stage/deviation.hpp"
#include "lab/experiments/timing/late_cycles.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"
#include "report/plot.hpp"
#include "report/statistics.hpp"

namespace depthgrid::experiments {

using nlohmann::ordered_json;

namespace {

constexpr double kLetter_s = 1.0 / 300;
constexpr double kBudgetShare = 0.6;  // of the period, for the distances

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) {
    total += value;
  }
  return total;
}

/// A histogram as a line: share of the cycles in bins of equal width on a logarithmic axis.
report::Series histogram(const std::string& label, const std::vector<double>& values_s) {
  constexpr int kBinsADecade = 12;
  constexpr int kFirst = -6 * kBinsADecade;  // 1 us
  constexpr int kBins = 5 * kBinsADecade;    // up to 0.1 s
  std::array<double, kBins> counts{};
  for (const double value : values_s) {
    const int bin = static_cast<int>(std::floor(kBinsADecade * std::log10(std::max(1e-6, value)))) - kFirst;
    counts.at(static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))) += 1;
  }
  report::Series series;
  series.label = label;
  series.markers = false;
  for (int bin = 0; bin < kBins; ++bin) {
    const double share = counts.at(static_cast<std::size_t>(bin)) / static_cast<double>(values_s.size());
    const double low_ms = 1e3 * std::pow(10.0, static_cast<double>(bin + kFirst) / kBinsADecade);
    const double high_ms = 1e3 * std::pow(10.0, static_cast<double>(bin + kFirst + 1) / kBinsADecade);
    series.x.insert(series.x.end(), {low_ms, high_ms});
    series.y.insert(series.y.end(), 2, share > 0 ? share : std::nan(""));
  }
  return series;
}

ordered_json free_figures(const FreeRun& run) {
  const double mean_s = sum(run.cycle_s) / static_cast<double>(run.cycle_s.size());
  return {{"cycles", run.cycle_s.size()},
          {"cycles_a_second", 1 / mean_s},
          {"cycles_a_second_by_the_wall", static_cast<double>(run.cycle_s.size()) / run.wall_s},
          {"median_ms", 1e3 * report::quantile(run.cycle_s, 0.5)},
          {"p999_ms", 1e3 * report::quantile(run.cycle_s, 0.999)},
          {"most_ms", 1e3 * report::quantile(run.cycle_s, 1)},
          {"distances_share", run.evaluate_s / run.wall_s}};
}

std::vector<std::string> free_row(const std::string& name, const ordered_json& figures) {
  return {name,
          report::fixed(figures["cycles_a_second"], 0),
          report::fixed(figures["cycles_a_second_by_the_wall"], 0),
          report::fixed(figures["median_ms"], 3),
          report::fixed(figures["p999_ms"], 3),
          report::fixed(figures["most_ms"], 3),
          report::percent(figures["distances_share"])};
}

struct PacedFigures {
  LateCycles late;
  std::vector<double> took_s, processor_s, end_s;
};

PacedFigures examine(const PacedRun& run, double period_s) {
  PacedFigures figures{late_cycles(run.periods, period_s), {}, {}, {}};
  for (const PeriodTimes& times : run.periods) {
    figures.took_s.push_back(times.took_s);
    figures.processor_s.push_back(times.processor_s);
    figures.end_s.push_back(times.late_s + times.took_s);
  }
  return figures;
}

std::string worst_cycle(const PacedRun& run) {
  const auto worst = std::max_element(run.periods.begin(), run.periods.end(), [](const auto& a, const auto& b) {
    return a.late_s + a.took_s < b.late_s + b.took_s;
  });
  return "begun " + report::fixed(1e3 * worst->late_s, 2) + " ms late, " + report::fixed(1e3 * worst->took_s, 2) +
         " ms long, of that " + report::fixed(1e3 * worst->evaluate_s, 2) + " ms distances; " +
         report::fixed(1e3 * worst->processor_s, 2) + " ms of processor time" +
         (worst->frame_arriving ? ", while a frame was taken" : "");
}

void draw_cycles(const std::string& name, const PacedFigures& figures, ExperimentReport& report) {
  report::Plot plot;
  plot.title = name + ": duration of the loop's cycles while frames arrive";
  plot.x_label = "ms (the letter states 3.3, the period is 2)";
  plot.y_label = "share of the cycles";
  plot.log_x = true;
  plot.log_y = true;
  plot.series = {histogram("wall clock", figures.took_s), histogram("processor time", figures.processor_s),
                 histogram("period's beginning to command", figures.end_s)};
  report::Canvas canvas(900, 450);
  report::draw_plot(canvas, {0, 0, 900, 450}, plot);
  std::string file = "cycles-" + name + ".png";
  std::replace(file.begin(), file.end(), ' ', '-');
  report.picture(file, std::move(canvas), "Histogram over the cycles, both axes logarithmic.");
}

void report_paced(const std::string& name, const PacedRun& run, const AvoidanceSettings& settings,
                  const search::Budget& budget, ExperimentReport& report, ordered_json& entry) {
  const PacedFigures figures = examine(run, settings.period_s);
  const LateCycles& late = figures.late;
  const std::size_t cycles = run.periods.size();
  const double share = static_cast<double>(late.in_time) / static_cast<double>(cycles);
  const double own_share =
      static_cast<double>(std::count_if(figures.processor_s.begin(), figures.processor_s.end(),
                                        [&](double value) { return value <= settings.period_s; })) /
      static_cast<double>(cycles);
  const double stopped =
      run.answered > 0 ? static_cast<double>(run.stopped_by_budget) / static_cast<double>(run.answered) : 0;
  report.headline(name + ": " + report::percent(share, 3) + " of " + std::to_string(cycles) +
                  " cycles had their command within 2 ms of the period's beginning while frames arrived (wanted: 99.9 "
                  "%); " +
                  report::percent(own_share, 3) + " took no more than 2 ms of processor time. Longest: " +
                  report::fixed(1e3 * report::quantile(figures.end_s, 1), 2) +
                  " ms after the beginning; largest processor time of any cycle: " +
                  report::fixed(1e3 * report::quantile(figures.processor_s, 1), 2) + " ms. " +
                  std::to_string(run.failed_cycles) + " cycles and " + std::to_string(run.failed_frames) +
                  " pairs of images failed.");
  report.paragraph(
      "Of the " + std::to_string(cycles - late.in_time) + " late ones " + std::to_string(late.after_overrun) +
      " came after one that lasted until more than half of their period had gone, " + std::to_string(late.woken_late) +
      " others were woken more than 1 ms late, " + std::to_string(late.interrupted) +
      " others did not have the processor all the time, " + std::to_string(late.computed) +
      " computed for 2 ms or longer. The worst cycle: " + worst_cycle(run) + ". Budget of the distances: " +
      report::fixed(1e3 * *budget.time_s, 2) + " ms a cycle; it ended " + report::percent(stopped, 3) +
      " of the answers. A pair of images took " + report::fixed(1e3 * report::quantile(run.frame_s, 0.5), 2) +
      " ms (median) and " + report::fixed(1e3 * report::quantile(run.frame_s, 1), 2) +
      " ms (most) on the other thread, robot removal included. " +
      (run.real_time_priority ? "The loop's thread had real-time priority."
                              : "The loop's thread had no real-time priority."));
  entry = {{"cycles", cycles},
           {"share_within_2_ms", share},
           {"share_within_2_ms_of_processor_time", own_share},
           {"median_ms", 1e3 * report::quantile(figures.took_s, 0.5)},
           {"p999_ms", 1e3 * report::quantile(figures.took_s, 0.999)},
           {"most_ms_after_beginning", 1e3 * report::quantile(figures.end_s, 1)},
           {"most_ms_of_processor_time", 1e3 * report::quantile(figures.processor_s, 1)},
           {"late",
            {{"after_overrun", late.after_overrun},
             {"woken_late", late.woken_late},
             {"interrupted", late.interrupted},
             {"computed", late.computed}}},
           {"failed_cycles", run.failed_cycles},
           {"failed_frame_pairs", run.failed_frames},
           {"worst_cycle", worst_cycle(run)},
           {"budget_ms", 1e3 * *budget.time_s},
           {"answers_ended_by_budget", stopped},
           {"frame_pair_median_ms", 1e3 * report::quantile(run.frame_s, 0.5)},
           {"frame_pair_most_ms", 1e3 * report::quantile(run.frame_s, 1)},
           {"real_time_priority", run.real_time_priority}};
  draw_cycles(name, figures, report);
}

/// The loop as fast as it goes, without frames arriving.
void report_free(const LoopRecording& recording, const AvoidanceSettings& settings, bool quick,
                 ExperimentReport& report) {
  const int snapshots = quick ? 10 : 40;
  const int cycles = quick ? 64 : 128;
  ordered_json& figures = report.figures();
  report::MarkdownTable table({"loop, no frames arriving, no budget", "cycles a second, processor time",
                               "by the wall clock", "median, ms", "99.9 %, ms", "most, ms", "of that, distances"});
  AvoidanceSettings bare = settings;  // what the letter asks: rho for the age of the image is not added
  bare.v_max_m_s = 0;
  AvoidanceSettings coarse = bare;
  coarse.resolution_m = 0.01;
  const auto add = [&](const char* key, const std::string& name, Method method, LoopParts parts,
                       const AvoidanceSettings& with, int count) {
    figures["free"][key] = free_figures(run_free(recording, method, parts, with, snapshots, count, {}));
    table.row(free_row(name, figures["free"][key]));
  };
  const LoopParts nine = LoopParts::nine_points;
  add("search_nine_points", "search, nine points", Method::search, nine, settings, cycles);
  add("search_nine_points_rho_04", "the same with rho 0.40 m", Method::search, nine, bare, cycles);
  add("search_nine_points_rho_04_10_mm", "the same with rho 0.40 m, resolution 10 mm", Method::search, nine, coarse,
      cycles);
  add("search_link_capsules", "search, six link capsules", Method::search, LoopParts::link_capsules, settings, cycles);
  if (recording.method() == Method::search_memory) {
    add("search_memory_nine_points", "search with memory, nine points", Method::search_memory, nine, settings, cycles);
    add("search_memory_link_capsules", "search with memory, six link capsules", Method::search_memory,
        LoopParts::link_capsules, settings, cycles);
  }
  add("letter_two", "letter, nine points, rho 0.40 m, hybrid", Method::letter_two, nine, settings,
      std::max(1, cycles / 16));
  const double rate = figures["free"]["search_nine_points"]["cycles_a_second"];
  const double letter_rate = figures["free"]["letter_two"]["cycles_a_second"];
  report.headline("Without frames arriving one core does " + report::fixed(rate, 0) +
                  " cycles of the whole loop a second with nine points (wanted: 3,000; by processor time, mean over " +
                  std::to_string(snapshots) + " instants), " + report::fixed(rate / letter_rate, 1) +
                  " times the same loop on the letter's evaluation, and " + report::fixed(rate * kLetter_s, 1) +
                  " times the 300 a second that the letter states for its machine.");
  report.paragraph(table.text());
  figures["free"]["search_beside_letter"] = rate / letter_rate;
}

}  // namespace

void run_timing(const Options& options, ExperimentReport& report) {
  const std::string_view sensor = sensor_or(options, "ideal");
  AvoidanceSettings settings = sensor_settings(sensor, width_or(options, 640, 640));
  settings.resolution_m = 0.005;
  const double recorded_s = frames_or(options, 150, 45) / kFrameRate_hz;
  const double paced_s = options.quick ? 10 : 60;
  const search::Budget budget{.time_s = kBudgetShare * settings.period_s};
  const auto steps = static_cast<std::size_t>(2 * paced_s) + 3;
  options.progress(0, steps);
  const LoopRecording recording(settings, recorded_s, options.seed,
                                options.sensor ? Method::search_memory : Method::search);
  options.progress(1, steps);
  report.paragraph(
      "A recording of the loop in simulated time (" + report::fixed(recorded_s, 1) + " s, " +
      std::to_string(recording.frames()) + " pairs of " + std::to_string(settings.width_px) + " x " +
      std::to_string(3 * settings.width_px / 4) + " images, 16 bits, " + std::string(sensor) +
      " sensor, person: " + recording.motion() +
      ") is played there and back: the arm stands where it stood, images come at 30 Hz, and robot removal, search "
      "(resolution 5 mm, rho " +
      report::fixed(search_settings(recording.rig(), settings).rho_m, 2) +
      " m), kinematics and controller run as they would on the robot. Only the commands go nowhere.");

  report_free(recording, settings, options.quick, report);
  options.progress(2, steps);
  std::size_t passed = 2;
  for (const LoopParts parts : {LoopParts::nine_points, LoopParts::link_capsules}) {
    const auto before = static_cast<double>(passed);
    const PacedRun run = run_paced(recording, parts, settings, paced_s, budget, [&](double at_s) {
      options.progress(static_cast<std::size_t>(before + at_s), steps);
    });
    passed += static_cast<std::size_t>(paced_s);
    const bool points = parts == LoopParts::nine_points;
    report_paced(points ? "nine points" : "link capsules", run, settings, budget, report,
                 report.figures()["paced"][points ? "nine_points" : "link_capsules"]);
  }
  options.progress(steps, steps);
}

}  // namespace depthgrid::experiments
