#include "lab/experiments/real_sensors/real_sensors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "depthgrid/robot/robot_parts.hpp"
#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/blind_layer/hand_beside.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/real_sensors/scene_play.hpp"
#include "lab/experiments/stage/declared_rig.hpp"
#include "lab/experiments/stage/rig_width.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"
#include "report/statistics.hpp"

namespace depthgrid::experiments {

using nlohmann::ordered_json;

namespace {

struct SceneRow {
  std::string_view sensor;
  int cameras;
  Scene scene;
};
constexpr std::array kRows{SceneRow{"kinect_v1", 2, Scene::nobody},      SceneRow{"kinect_v1", 2, Scene::reach},
                           SceneRow{"kinect_v1", 2, Scene::hand_behind}, SceneRow{"kinect_v1", 3, Scene::hand_behind},
                           SceneRow{"realsense_d435", 2, Scene::nobody}, SceneRow{"realsense_d435", 3, Scene::nobody},
                           SceneRow{"realsense_d455", 2, Scene::nobody}, SceneRow{"realsense_d455", 3, Scene::nobody},
                           SceneRow{"ideal", 2, Scene::reach},           SceneRow{"ideal", 2, Scene::hand_behind}};
constexpr std::array kBallGaps_m{0.02, 0.05, 0.10, 0.20};
constexpr std::array kBallSensors{"kinect_v1", "realsense_d435"};
constexpr int kBallSeen = 30;  ///< images at 30 Hz, then one that is asked

/// Median and worst of a figure over seeds; `worst` is the largest or, where more is better, the smallest.
struct Spread {
  double median;
  double worst;
};
Spread spread(const std::vector<double>& values, bool more_is_better) {
  return {report::quantile(values, 0.5), report::quantile(values, more_is_better ? 0 : 1)};
}
std::string percents(const Spread& value) {
  return report::percent(value.median) + " / " + report::percent(value.worst);
}
std::string millimetres(const Spread& value) {
  return report::fixed(1000 * value.median) + " / " + report::fixed(1000 * value.worst);
}
ordered_json json_of(const Spread& value) {
  const auto number = [](double x) { return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr); };
  return {{"median", number(value.median)}, {"worst", number(value.worst)}};
}

/// One scene with one search, all seeds.
void add_scene(const SceneRow& row, bool declared, const std::vector<SceneFigures>& seeds, report::MarkdownTable& table,
               ordered_json& figures) {
  const auto over_seeds = [&](double SceneFigures::*figure, bool more_is_better) {
    std::vector<double> values;
    for (const SceneFigures& seed : seeds) {
      if (!std::isnan(seed.*figure)) {
        values.push_back(seed.*figure);
      }
    }
    return spread(values, more_is_better);
  };
  const Spread false_obstacles = over_seeds(&SceneFigures::false_obstacles, false);
  const Spread nothing_near = over_seeds(&SceneFigures::nothing_near, true);
  const Spread clear = over_seeds(&SceneFigures::every_link_clear, true);
  const Spread short_m = over_seeds(&SceneFigures::short_median_m, false);
  const Spread over_m = over_seeds(&SceneFigures::largest_overestimate_m, false);
  const std::string name = std::string(row.sensor) + " x " + std::to_string(row.cameras) + ", " +
                           std::string(to_string(row.scene)) + (declared ? ", declared" : "");
  table.row({name, percents(false_obstacles), percents(nothing_near), percents(clear), millimetres(short_m),
             millimetres(over_m)});
  figures[name] = {{"seeds", seeds.size()},
                   {"answers", seeds.front().answers},
                   {"false_obstacles", json_of(false_obstacles)},
                   {"nothing_within_0.4_m_where_true", json_of(nothing_near)},
                   {"every_link_10_cm_clear", json_of(clear)},
                   {"short_median_m", json_of(short_m)},
                   {"largest_overestimate_m", json_of(over_m)}};
}

bool is_asked(const Options& options, std::string_view sensor) {
  return !options.sensor || sensor_or(options, sensor) == sensor;
}

/// The whole arm's answer less how near the ball is to the nearest moving link.
double ball_error_m(std::string_view sensor, int width_px, double gap_m, double padding_m, std::uint64_t seed) {
  HandBeside scene(with_width(simulation::letter_arrangement(sensor).rig, width_px), seed);
  RememberedScene remembered(scene, padding_m);
  remembered.see(HandPlace::beside, gap_m, kBallSeen + 1);
  const std::vector<robot::LinkCapsule> links = robot::moving_capsules(scene.arm().model());
  std::vector<Capsule> links_world(links.size());
  robot::place(links, scene.arm().T_world_link(), links_world);
  double answer_m = 1;
  double truth_m = 1;
  for (const Capsule& link : links_world) {
    answer_m = std::min(answer_m, remembered.distance(link).nearest.distance_m);
    truth_m = std::min(truth_m, distance_to_axis(link, scene.hand_world()) - link.radius_m - kHandRadius_m);
  }
  return answer_m - truth_m;
}

void report_balls(const Options& options, int width_px, int seeds, ExperimentReport& report) {
  report::MarkdownTable table({"sensor", "padding, m", "ball at 2 cm", "5 cm", "10 cm", "20 cm"});
  for (const std::string_view sensor : kBallSensors) {
    if (!is_asked(options, sensor)) {
      continue;
    }
    for (const double padding_m : {thin_padding_m(sensor) - 0.01, thin_padding_m(sensor)}) {
      std::vector<std::string> cells{std::string(sensor), report::fixed(padding_m, 2)};
      for (const double gap_m : kBallGaps_m) {
        std::vector<double> errors_m;
        errors_m.reserve(static_cast<std::size_t>(seeds));
        for (int seed = 0; seed < seeds; ++seed) {
          errors_m.push_back(
              ball_error_m(sensor, width_px, gap_m, padding_m, options.seed + static_cast<std::uint64_t>(seed)));
        }
        const Spread error{report::quantile(errors_m, 0.5), report::quantile(errors_m, 1)};
        cells.push_back(millimetres(error));
        report.figures()["ball"][std::string(sensor)]["padding " + report::fixed(padding_m, 2)]
                        [report::fixed(gap_m, 2)] = {
            {"median_m", error.median}, {"largest_m", error.worst}, {"least_m", report::quantile(errors_m, 0)}};
      }
      table.row(cells);
    }
  }
  report.paragraph(
      "A ball of 5 cm radius stands beside the last link in view of both cameras: the whole arm's answer less the "
      "truth, "
      "mm, median / largest of the seeds.");
  report.paragraph(table.text());
}

}  // namespace

void run_real_sensors(const Options& options, ExperimentReport& report) {
  const int seeds = frames_or(options, 3, 1);
  const int width_px = width_or(options, 640, 640);
  const double duration_s = options.quick ? 1 : 4;
  report.paragraph(
      "The letter's two cameras, or three on a circle, " + std::to_string(width_px) + " x " +
      std::to_string(3 * width_px / 4) + " pixels, 30 Hz, " + std::to_string(seeds) +
      " seeds; nine points of the arm, rho 0.4 m, asked every third image after a first second. *Declared*: the "
      "sensor's smallest obstacle and second view, a memory that begins with nothing known (v_max 2 m/s, half an "
      "exposure 8 ms), a thin layer with the sensor's margin in the test. Otherwise a pixel without reading frees "
      "nothing. Figures are the median and the worst of the seeds.");
  report::MarkdownTable table({"scene", "more than 100 mm too near", "nothing within 0.4 m, where true",
                               "every link 10 cm clear, person 0.5 m away", "too near, median, mm", "farthest, mm"});
  const std::size_t total = 2 * kRows.size() * static_cast<std::size_t>(seeds);
  std::size_t done = 0;
  for (const SceneRow& row : kRows) {
    for (const bool declared : {false, true}) {
      std::vector<SceneFigures> figures;
      for (int seed = 0; seed < seeds; ++seed) {
        if (is_asked(options, row.sensor)) {
          figures.push_back(play({row.sensor, row.cameras, width_px, row.scene, duration_s,
                                  options.seed + static_cast<std::uint64_t>(seed), declared}));
        }
        options.progress(++done, total);
      }
      if (!figures.empty()) {
        add_scene(row, declared, figures, table, report.figures()["scenes"]);
      }
    }
  }
  report.paragraph(table.text());
  report_balls(options, width_px, seeds, report);
}

}  // namespace depthgrid::experiments
