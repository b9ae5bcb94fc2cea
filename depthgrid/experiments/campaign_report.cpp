#include "depthgrid/experiments/campaign_report.hpp"

#include <algorithm>

#include "depthgrid/experiments/experiment_report.hpp"
#include "depthgrid/experiments/markdown_table.hpp"
#include "depthgrid/experiments/plate_scene.hpp"
#include "depthgrid/report/plot.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"

namespace depthgrid::experiments {

using nlohmann::ordered_json;

namespace {

constexpr double kSameTime = 1.02;  // with nobody there a method may take this much longer
constexpr double kSlowest = 1.5;    // of the letter's time per vertex

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
  for (const Method method : kMethods) {
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
std::map<Method, double> alone_s_per_vertex(const CampaignPlan& plan) {
  const robot::RobotModel model = robot::kuka_lwr4();
  RunSettings settings;
  settings.common = plan.common;
  settings.duration_s = plan.duration_s;
  std::map<Method, double> result;
  for (const Method method : kMethods) {
    const RunResult run = run_avoidance(method, model, nobody(plan.duration_s), settings);
    result[method] = run.duration_s / run.task_share;
  }
  return result;
}

void say_what_was_done(const CampaignPlan& plan, const CampaignState& state, ExperimentReport& report) {
  report.paragraph(
      std::to_string(state.motions.size()) + " motions of " + fixed(plan.duration_s) +
      " s around the time when the person is nearest, with every method: the arm goes round a hexagon (radius 0.2 m, "
      "0.40 m/s) that stands in the plane between the letter's two cameras. Images: " +
      std::to_string(plan.common.width_px) + " x " + std::to_string(3 * plan.common.width_px / 4) + ", " +
      std::string(plan.common.sensor) + " sensor, 30 Hz, " + fixed(1000 * plan.common.frame_latency_s) +
      " ms late; commands every 2 ms, distances every " + fixed(2.0 * plan.common.evaluate_every) +
      " ms. The person does not avoid the robot, and walks into it where its script leads. Truth: exact distances "
      "between bodies, every 2 ms. The letter asks nine points, repels the end effector by the mean (11) as printed "
      "and "
      "limits the body by the risk; the search asks the links' capsules, repels by the corrected direction and limits "
      "all of them by approach rows (gain " +
      fixed(plan.common.approach_gain_per_s, 1) + " 1/s, stop " + fixed(plan.common.approach_stop_m, 2) +
      " m), with v_max = " + fixed(plan.common.v_max_m_s, 1) +
      " m/s. All that nobody sees is an obstacle to it; in the last row pockets of up to " +
      fixed(plan.common.ignored_pocket_m, 2) + " m right behind the robot are not (declared).");
}

}  // namespace

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
    }
    smallest_m.push_back(run.smallest_person_m);
    share += run.task_share;
    sum.in_contact_s += run.in_contact_s;
    sum.stopped_share += run.stopped_s;
    sum.false_stop_share += run.false_stop_s;
    sum.over_estimates += run.over_estimates;
    sum.largest_over_estimate_m = std::max(sum.largest_over_estimate_m, run.largest_over_estimate_m);
    sum.watched += run.watched;
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

std::vector<Contact> contacts_caused(const CampaignState& state, Method method, double v_max_m_s) {
  std::vector<Contact> caused;
  for (const auto& [number, outcome] : state.motions) {
    for (const Contact& contact : outcome.runs.at(method).contacts) {
      if (contact.robot_m_s > kStanding_m_s && contact.person_m_s <= v_max_m_s) {
        caused.push_back(contact);
      }
    }
  }
  return caused;
}

void report_campaign(const CampaignPlan& plan, const CampaignState& state, ExperimentReport& report) {
  say_what_was_done(plan, state, report);
  const std::map<Method, double> alone = alone_s_per_vertex(plan);
  ordered_json& figures = report.figures();
  figures["settings"] = state.settings;
  std::vector<std::vector<std::string>> rows;
  std::map<Method, MethodTotals> sums;
  for (const Method method : kMethods) {
    const MethodTotals sum = totals(state, method, plan.duration_s);
    sums[method] = sum;
    rows.push_back({std::string(title(method)), std::to_string(sum.with_contact) + " of " + std::to_string(sum.motions),
                    causes_text(sum), fixed(sum.worst_robot_m_s, 2), fixed(sum.median_smallest_m, 3),
                    fixed(sum.s_per_vertex, 3), fixed(alone.at(method), 3), percent(sum.stopped_share),
                    percent(sum.false_stop_share)});
    ordered_json entry{{"motions", sum.motions},
                       {"motions_with_contact", sum.with_contact},
                       {"contacts", sum.contacts},
                       {"fastest_robot_at_contact_m_s", sum.worst_robot_m_s},
                       {"in_contact_s", sum.in_contact_s},
                       {"smallest_distance_m", sum.smallest_m},
                       {"median_smallest_distance_m", sum.median_smallest_m},
                       {"s_per_vertex", sum.s_per_vertex},
                       {"s_per_vertex_with_nobody", alone.at(method)},
                       {"stopped_share", sum.stopped_share},
                       {"false_stop_share", sum.false_stop_share}};
    for (const auto& [cause, count] : sum.causes) {
      entry["causes"][std::string(to_string(cause))] = count;
    }
    if (is_search(method)) {
      entry["over_estimates"] = sum.over_estimates;
      entry["largest_over_estimate_m"] = sum.largest_over_estimate_m;
      entry["compared"] = sum.watched;
    }
    figures[std::string(key(method))] = entry;
  }
  report.paragraph(markdown_table(
      {"method", "motions with contact", "contacts by cause",
       "fastest robot point at a contact, towards the person, m/s", "median of the smallest distances, m",
       "s per vertex", "with nobody there", "stopped", "stopped with nothing within 0.4 m"},
      rows));
  report.paragraph(
      "robot_stood: the touched point came nearer at no more than 0.05 m/s. faster_than_v_max: so did not, but the "
      "person "
      "came faster than the search was told. hidden: so did not, and the method held the link for farther away than it "
      "was. robot_came: none of these.");

  double slowest_alone = 0;
  for (const Method method : kMethods) {
    slowest_alone = std::max(slowest_alone, alone.at(method) / alone.at(Method::none));
  }
  figures["claims"]["slowest_with_nobody_beside_no_avoidance"] = slowest_alone;
  report.headline("Task time with nobody there, slowest method beside no avoidance: " + fixed(slowest_alone, 3) +
                  " (wanted: at most " + fixed(kSameTime, 2) + ").");
  for (const Method method : {Method::search, Method::search_pockets}) {
    const auto caused = contacts_caused(state, method, plan.common.v_max_m_s);
    const double ratio = sums[method].s_per_vertex / sums[Method::letter_two].s_per_vertex;
    ordered_json& claims = figures["claims"][std::string(key(method))];
    claims = {{"contacts_caused_by_the_robot", caused.size()}, {"time_beside_letter_two", ratio}};
    report.headline(std::string(title(method)) + ": " + std::to_string(caused.size()) +
                    " contacts at which the touched point came towards a person no faster than v_max at more than 0.05 "
                    "m/s (wanted: none); task time beside the letter with two cameras " +
                    fixed(ratio, 2) + " (wanted: at most " + fixed(kSlowest, 1) +
                    "); a link held for more than 1 cm farther from the person than it was in " +
                    std::to_string(sums[method].over_estimates) + " of " + std::to_string(sums[method].watched) +
                    " periods with the person within 0.4 m, by " +
                    fixed(1000 * std::max(0.0, sums[method].largest_over_estimate_m)) + " mm at most.");
  }
  report.picture("smallest-distances.png", picture_of_distances(state),
                 "Each motion's smallest true distance, sorted; distances above 1 m are drawn there.");

  std::map<Method, PlateScene> scenes;
  for (const Method method : {Method::letter_one, Method::letter_two, Method::search}) {
    scenes[method] = plate_scene(method, plan.common);
    figures["plate"][std::string(key(method))] = {
        {"fastest_towards_nearest_m_s", scenes[method].fastest_towards_nearest_m_s},
        {"fastest_towards_hand_m_s", scenes[method].fastest_towards_hand_m_s},
        {"smallest_distance_m", scenes[method].smallest_m},
        {"contacts", scenes[method].contacts}};
  }
  const auto towards = [&](Method method) { return fixed(scenes[method].fastest_towards_nearest_m_s, 2) + " m/s"; };
  report.headline(
      "Hand against plate: the repulsion points towards what the method itself holds for nearest at up to " +
      towards(Method::letter_one) + " (letter, 1 camera), " + towards(Method::letter_two) + " (letter, 2 cameras), " +
      towards(Method::search) + " (search).");
  report.picture("hand-against-plate.png", picture_of_plate(scenes),
                 "A hand stops near the end effector; a large plate hangs farther away on the other side.");
}

}  // namespace depthgrid::experiments
