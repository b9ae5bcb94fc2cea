#include "lab/experiments/campaign/campaign_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/campaign/campaign_motions.hpp"
#include "lab/experiments/campaign/campaign_totals.hpp"
#include "lab/experiments/campaign/plate_scene.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"
#include "report/plot.hpp"

namespace depthgrid::experiments {

using nlohmann::ordered_json;

namespace {

constexpr double kSameTime = 1.02;  // with nobody there a method may take this much longer

double smallest_shown_m(double distance_m) { return std::min(distance_m, 1.0); }

std::string causes_text(const MethodTotals& sum) {
  std::string text;
  for (const auto& [cause, count] : sum.causes) {
    text += (text.empty() ? "" : ", ") + std::string(to_string(cause)) + " " + std::to_string(count);
  }
  return text.empty() ? "none" : text;
}

report::Canvas picture_of_distances(const CampaignState& state) {
  report::Plot plot;
  plot.title = "smallest true distance to the person, by motion";
  plot.x_label = "share of the motions with less";
  plot.y_label = "smallest distance (m)";
  for (const Method method : methods_of(state.settings)) {
    report::Series series;
    series.label = title(method);
    series.markers = false;
    for (const auto& [number, outcome] : state.motions) {
      series.y.push_back(smallest_shown_m(outcome.runs.at(method).smallest_person_m));
    }
    std::sort(series.y.begin(), series.y.end());
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      series.x.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(series.y.size()));
    }
    plot.series.push_back(std::move(series));
  }
  report::Canvas canvas(900, 500);
  report::draw_plot(canvas, {0, 0, 900, 500}, plot);
  return canvas;
}

report::Canvas picture_of_plate(const std::map<Method, PlateScene>& scenes) {
  report::Plot distance;
  distance.title = "a near hand against a far, large plate: true distance to the hand";
  distance.x_label = "time (s)";
  distance.y_label = "distance (m)";
  report::Plot towards;
  towards.title = "repulsion of the end effector towards what the method holds for nearest (above 0: into it)";
  towards.x_label = "time (s)";
  towards.y_label = "speed (m/s)";
  for (const auto& [method, scene] : scenes) {
    distance.series.push_back({std::string(title(method)), scene.time_s, scene.hand_m, false, true});
    towards.series.push_back({std::string(title(method)), scene.time_s, scene.towards_nearest_m_s, false, true});
  }
  report::Canvas canvas(900, 800);
  report::draw_plot(canvas, {0, 0, 900, 400}, distance);
  report::draw_plot(canvas, {0, 400, 900, 400}, towards);
  return canvas;
}

/// Seconds for one vertex with nobody there.
std::map<Method, double> alone_s_per_vertex(const CampaignPlan& plan, const CampaignState& state) {
  const robot::RobotModel model = robot::kuka_lwr4();
  RunSettings settings;
  settings.duration_s = plan.duration_s;
  std::map<Method, double> result;
  for (const Method method : methods_of(state.settings)) {
    settings.common = settings_of(plan, method);
    const RunResult run = run_avoidance(method, model, nobody(plan.duration_s), settings);
    result[method] = run.duration_s / run.summary.task_share;
  }
  return result;
}

void say_what_was_done(const CampaignPlan& plan, const CampaignState& state, ExperimentReport& report) {
  report.paragraph(
      std::to_string(state.motions.size()) + " motions of " + report::fixed(plan.duration_s) +
      " s around the time when the person is nearest, with every method: the arm goes round a hexagon (radius " +
      report::fixed(kHexagonRadius_m, 1) +
      " m, 0.40 m/s) that stands in the plane between the letter's two cameras. Images: " +
      std::to_string(plan.common.width_px) + " x " + std::to_string(3 * plan.common.width_px / 4) + ", " +
      std::string(plan.common.sensor) + " sensor, " + report::fixed(kFrameRate_hz) + " Hz, " +
      report::fixed(1000 * plan.common.frame_latency_s) + " ms late; commands every " +
      report::fixed(1000 * plan.common.period_s) + " ms, distances every " +
      report::fixed(1000 * plan.common.period_s * plan.common.evaluate_every) +
      " ms. The person does not avoid the robot, and walks into it where its script leads. Truth: exact distances "
      "between bodies, every 2 ms. The letter asks nine points, repels the end effector by the mean (11) as printed "
      "and limits the body by the risk; the search asks the links' capsules, repels by the corrected direction and "
      "limits all of them by approach rows (gain " +
      report::fixed(plan.common.approach_gain_per_s, 1) + " 1/s, stop " +
      report::fixed(plan.common.approach_stop_m, 2) + " m), with v_max = " + report::fixed(plan.common.v_max_m_s, 1) +
      " m/s. All that nobody sees is an obstacle to it; in the last row pockets of up to " +
      report::fixed(plan.common.ignored_pocket_m, 2) + " m right behind the robot are not (declared).");
  if (plan.with_memory) {
    report.paragraph("The search with memory alone has " + std::string(plan.with_memory->sensor) + " images of " +
                     std::to_string(plan.with_memory->width_px) + " x " +
                     std::to_string(3 * plan.with_memory->width_px / 4) + ", distances every " +
                     report::fixed(1000 * plan.with_memory->period_s * plan.with_memory->evaluate_every) +
                     " ms, and what is declared for that sensor.");
  }
  const bool recordings = state.settings.value("recordings", false);
  report.paragraph(recordings ? "One motion in six is a recorded one (CMU motion capture, subject 02)."
                              : "Scripted motions only: no recordings were found in " + mocap_folder().string() + ".");
}

ordered_json figures_of_totals(Method method, const MethodTotals& sum, double alone_s) {
  ordered_json entry{{"motions", sum.motions},
                     {"motions_with_contact", sum.with_contact},
                     {"contacts", sum.contacts},
                     {"fastest_robot_at_contact_m_s", sum.worst_robot_m_s},
                     {"fastest_robot_during_contact_m_s", sum.worst_during_m_s},
                     {"in_contact_s", sum.in_contact_s},
                     {"object_contacts", sum.object_contacts},
                     {"smallest_distance_m", sum.smallest_m},
                     {"median_smallest_distance_m", sum.median_smallest_m},
                     {"s_per_vertex", sum.s_per_vertex},
                     {"s_per_vertex_with_nobody", alone_s},
                     {"stopped_share", sum.stopped_share},
                     {"false_stop_share", sum.false_stop_share}};
  for (const auto& [cause, count] : sum.causes) {
    entry["causes"][std::string(to_string(cause))] = count;
  }
  if (is_search(method)) {
    entry["over_estimates"] = sum.over_estimates;
    entry["largest_over_estimate_m"] = sum.largest_over_estimate_m;
    entry["compared"] = sum.compared;
  }
  return entry;
}

void report_totals(const std::map<Method, MethodTotals>& sums, const std::map<Method, double>& alone,
                   ExperimentReport& report) {
  report::MarkdownTable table({"method", "motions with contact", "contacts by cause",
                               "fastest robot point at a contact's beginning, towards the person, m/s",
                               "while contacts lasted, m/s", "median of the smallest distances, m", "s per vertex",
                               "with nobody there", "stopped", "stopped with nothing within 0.4 m"});
  for (const auto& [method, sum] : sums) {
    table.row({std::string(title(method)), std::to_string(sum.with_contact) + " of " + std::to_string(sum.motions),
               causes_text(sum), report::fixed(sum.worst_robot_m_s, 2), report::fixed(sum.worst_during_m_s, 2),
               report::fixed(sum.median_smallest_m, 3), report::fixed(sum.s_per_vertex, 3),
               report::fixed(alone.at(method), 3), report::percent(sum.stopped_share),
               report::percent(sum.false_stop_share)});
    report.figures()[std::string(key(method))] = figures_of_totals(method, sum, alone.at(method));
  }
  report.paragraph(table.text());
  report.paragraph(
      "touched_from_the_start: the motion began so, and no speed is known. robot_stood: the touched point came nearer "
      "at no more than 0.05 m/s. faster_than_v_max: so did not, but the person came faster than the search was told. "
      "hidden: so did not, and the method held the link for farther away than it was. robot_came: none of these. While "
      "a contact lasts the speed is that of the point touched first, along the line of nearest points before.");
}

std::string time_text(const std::string& name, const TimeBesideLetter& time) {
  return name + " " + report::fixed(time.ratio, 2) + ", above in " + std::to_string(time.above_wanted) + " of " +
         std::to_string(time.motions) + " motions, less than one vertex in " + std::to_string(time.below_one_vertex) +
         " (letter: " + std::to_string(time.letter_below_vertex) + ")";
}

/// Scripts and recordings apart: a sum hides motions in which a method does nothing.
void report_time(const CampaignState& state, Method method, ExperimentReport& report) {
  std::string text;
  ordered_json& claims = report.figures()["claims"][std::string(key(method))]["time_beside_letter_two"];
  for (const auto& [which, name] : {std::pair{Motions::all, "all"}, std::pair{Motions::scripts, "scripts"},
                                    std::pair{Motions::recordings, "recordings"}}) {
    const TimeBesideLetter time = time_beside_letter(state, method, which);
    if (time.motions == 0) {
      continue;
    }
    claims[name] = {{"motions", time.motions},
                    {"ratio", std::isfinite(time.ratio) ? ordered_json(time.ratio) : ordered_json(nullptr)},
                    {"motions_above_wanted", time.above_wanted},
                    {"motions_below_one_vertex", time.below_one_vertex},
                    {"motions_below_one_vertex_letter_two", time.letter_below_vertex}};
    text += (text.empty() ? "" : "; ") + time_text(name, time);
  }
  report.headline(std::string(title(method)) + ": task time beside the letter with two cameras (wanted: at most " +
                  report::fixed(kSlowest, 1) + "): " + text + ".");
}

void report_contacts_caused(const CampaignState& state, Method method, const MethodTotals& sum,
                            ExperimentReport& report) {
  const auto caused = contacts_caused(state, method);
  report.figures()["claims"][std::string(key(method))]["contacts_caused_by_the_robot"] = caused.size();
  const auto begun = sum.causes.find(ContactCause::touched_from_the_start);
  report.headline(std::string(title(method)) + ": " + std::to_string(caused.size()) +
                  " contacts that began with the touched point coming towards a person no faster than v_max at more "
                  "than 0.05 m/s (wanted: none), beside " +
                  std::to_string(begun == sum.causes.end() ? 0 : begun->second) +
                  " at the start, which are not judged; the nearest link held for more than 1 cm farther from the "
                  "person than it was in " +
                  std::to_string(sum.over_estimates) + " of " + std::to_string(sum.compared) +
                  " periods with the person within 0.4 m, by " +
                  report::fixed(1000 * std::max(0.0, sum.largest_over_estimate_m)) + " mm at most.");
}

void report_plate(const CampaignPlan& plan, ExperimentReport& report) {
  std::map<Method, PlateScene> scenes;
  for (const Method method : {Method::letter_one, Method::letter_two, Method::search}) {
    scenes[method] = plate_scene(method, plan.common);
    report.figures()["plate"][std::string(key(method))] = {
        {"fastest_towards_nearest_m_s", scenes[method].fastest_towards_nearest_m_s},
        {"fastest_towards_hand_m_s", scenes[method].fastest_towards_hand_m_s},
        {"smallest_distance_m", scenes[method].smallest_m},
        {"contacts", scenes[method].contacts}};
  }
  const auto towards = [&](Method method) {
    return report::fixed(scenes[method].fastest_towards_nearest_m_s, 2) + " m/s";
  };
  report.headline(
      "Hand against plate: the repulsion points towards what the method itself holds for nearest at up to " +
      towards(Method::letter_one) + " (letter, 1 camera), " + towards(Method::letter_two) + " (letter, 2 cameras), " +
      towards(Method::search) + " (search).");
  report.picture("hand-against-plate.png", picture_of_plate(scenes),
                 "A hand stops near the end effector; a large plate hangs farther away on the other side.");
}

}  // namespace

void report_campaign(const CampaignPlan& plan, const CampaignState& state, ExperimentReport& report) {
  say_what_was_done(plan, state, report);
  const std::map<Method, double> alone = alone_s_per_vertex(plan, state);
  report.figures()["settings"] = state.settings;
  std::map<Method, MethodTotals> sums;
  double slowest_alone = 0;
  for (const Method method : methods_of(state.settings)) {
    sums[method] = totals(state, method, plan.duration_s);
    slowest_alone = std::max(slowest_alone, alone.at(method) / alone.at(Method::none));
  }
  report_totals(sums, alone, report);
  report.figures()["claims"]["slowest_with_nobody_beside_no_avoidance"] = slowest_alone;
  report.headline("Task time with nobody there, slowest method beside no avoidance: " +
                  report::fixed(slowest_alone, 3) + " (wanted: at most " + report::fixed(kSameTime, 2) + ").");
  for (const Method method : methods_of(state.settings)) {
    if (!is_search(method)) {
      continue;
    }
    report_contacts_caused(state, method, sums.at(method), report);
    report_time(state, method, report);
  }
  report.picture("smallest-distances.png", picture_of_distances(state),
                 "Each motion's smallest true distance, sorted; distances above 1 m are drawn there.");
  if (!plan.with_memory) {
    report_plate(plan, report);
  }
}

}  // namespace depthgrid::experiments
