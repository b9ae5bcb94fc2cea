#include "lab/experiments/avoidance/avoidance.hpp"

#include <algorithm>
#include <map>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/loop/avoidance_run.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"
#include "report/plot.hpp"

namespace depthgrid::experiments {

using nlohmann::ordered_json;

namespace {

/// One sensor's runs.
struct Comparison {
  std::string sensor;
  AvoidanceSettings settings;
  std::map<Method, RunResult> runs;
};

/// Draws x and z of the world into a square panel; the same metres a pixel in every panel.
class PathPanel {
 public:
  PathPanel(report::Canvas& canvas, double left_px, double top_px)
      : canvas_(canvas), left_px_(left_px), top_px_(top_px) {}

  [[nodiscard]] report::CanvasPoint at(double x_m, double z_m) const {
    return {left_px_ + kScale * (x_m - kLeft), top_px_ + kScale * (kTop - z_m)};
  }
  [[nodiscard]] report::Rectangle area() const { return {left_px_, top_px_, kSide, kSide}; }

  void grid(const std::string& name) {
    for (int i = 0; i <= kSteps; ++i) {
      const double x_m = kLeft + i * kStep;
      const double z_m = kTop - i * kStep;
      canvas_.line(at(x_m, kTop), at(x_m, kTop - kSide / kScale), {report::Colour{0.87, 0.87, 0.87}, 1});
      canvas_.line(at(kLeft, z_m), at(kLeft + kSide / kScale, z_m), {report::Colour{0.87, 0.87, 0.87}, 1});
      const report::CanvasPoint below = at(x_m, kTop - kSide / kScale);
      canvas_.text({below.x_px, below.y_px + 16}, report::fixed(x_m, 2), 12, report::kBlack, report::Align::centre);
      const report::CanvasPoint beside = at(kLeft, z_m);
      canvas_.text({beside.x_px - 6, beside.y_px + 4}, report::fixed(z_m, 2), 12, report::kBlack, report::Align::right);
    }
    canvas_.outline(area(), {report::kBlack, 1});
    canvas_.text({left_px_ + kSide / 2, top_px_ - 10}, name, 15, report::kBlack, report::Align::centre);
    canvas_.text({left_px_ + kSide / 2, top_px_ + kSide + 34}, "x (m); upwards z (m)", 12, report::kBlack,
                 report::Align::centre);
  }
  void path(const std::vector<report::CanvasPoint>& points, const report::Colour& colour, double width_px) {
    canvas_.clip(area());
    canvas_.polyline(points, {colour, width_px});
    canvas_.unclip();
  }

  static constexpr double kSide = 330;  // pixels

 private:
  static constexpr double kLeft = -0.75, kTop = 1.35, kScale = 220, kStep = 0.25;  // metres, pixels a metre, metres
  static constexpr int kSteps = 6;                                                 // kSide / kScale / kStep
  report::Canvas& canvas_;
  double left_px_;
  double top_px_;
};

report::Canvas picture_of_paths(const Comparison& comparison, const std::vector<Eigen::Vector3d>& hexagon) {
  constexpr double kPitch = PathPanel::kSide + 70;
  report::Canvas canvas(static_cast<int>(3 * kPitch) + 20, static_cast<int>(2 * kPitch) + 30);
  int number = 0;
  for (const auto& [method, run] : comparison.runs) {
    const int row = number / 3;
    PathPanel panel(canvas, 60 + kPitch * (number % 3), 40 + (kPitch + 10) * row);
    panel.grid(std::string(title(method)));
    std::vector<report::CanvasPoint> task;
    for (std::size_t i = 0; i <= hexagon.size(); ++i) {
      task.push_back(panel.at(hexagon[i % hexagon.size()].x(), hexagon[i % hexagon.size()].z()));
    }
    std::vector<report::CanvasPoint> path;
    for (const RunSample& sample : run.samples) {
      path.push_back(panel.at(sample.end_effector_world.x(), sample.end_effector_world.z()));
    }
    panel.path(task, report::Colour{0.5, 0.6, 0.8}, 3);
    panel.path(path, report::Colour{0.78, 0.2, 0.05}, 1.5);
    ++number;
  }
  return canvas;
}

bool is_shown(Method /*method*/) { return true; }
/// What does not avoid evaluates nothing.
bool evaluates(Method method) { return method != Method::none; }

/// One line a method over time, of those that `shows` says.
template <class Value>
report::Plot over_time(const Comparison& comparison, std::string name, std::string label, bool (*shows)(Method),
                       Value value) {
  report::Plot plot;
  plot.title = std::move(name);
  plot.x_label = "time (s)";
  plot.y_label = std::move(label);
  for (const auto& [method, run] : comparison.runs) {
    // A method keeps its colour in all plots.
    report::Series series{std::string(title(method)) + (shows(method) ? "" : ": none"), {}, {}, false, true};
    for (const RunSample& sample : run.samples) {
      if (shows(method)) {
        series.x.push_back(sample.time_s);
        series.y.push_back(value(sample));
      }
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

report::Canvas picture_over_time(const Comparison& comparison) {
  const auto body_m = [&](const RunSample& sample) {
    double nearest_m = comparison.settings.rho_m;
    for (std::size_t i = 1; i < sample.told_m.size(); ++i) {
      nearest_m = std::min(nearest_m, sample.told_m[i]);
    }
    return nearest_m;
  };
  const double shown_m = 1.0;
  const std::vector<report::Plot> plots{
      over_time(comparison, "true distance from the moving links to the person", "m (1 and more: 1)", is_shown,
                [&](const RunSample& sample) { return std::min(shown_m, sample.true_person_m); }),
      over_time(comparison, "distance of the end effector as evaluated", "m (0.4: nothing near)", evaluates,
                [](const RunSample& sample) { return sample.told_m.front(); }),
      over_time(comparison, "smallest distance of the other points or links as evaluated", "m (0.4: nothing near)",
                evaluates, body_m),
      over_time(comparison, "repulsive velocity of the end effector", "m/s", evaluates,
                [](const RunSample& sample) { return sample.repulsion_m_s.norm(); })};
  report::Canvas canvas(1000, 1200);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    report::draw_plot(canvas, {0, 300.0 * static_cast<double>(i), 1000, 300}, plots[i]);
  }
  return canvas;
}

ordered_json figures_of(const RunResult& run) {
  ordered_json entry{{"smallest_distance_m", run.summary.smallest_person_m},
                     {"contacts", run.summary.contacts.size()},
                     {"in_contact_s", run.summary.in_contact_s},
                     {"vertices", run.vertices},
                     {"s_per_vertex",
                      run.vertices > 0 ? ordered_json(run.duration_s / run.summary.task_share) : ordered_json(nullptr)},
                     {"stopped_s", run.summary.stopped_s},
                     {"stopped_with_nothing_within_rho_s", run.summary.false_stop_s},
                     {"object_contacts", run.summary.object_contacts},
                     {"over_estimates", run.summary.over_estimates},
                     {"periods_compared", run.summary.compared}};
  for (const Contact& contact : run.summary.contacts) {
    entry["contact_causes"].push_back(to_string(contact.cause));
  }
  return entry;
}

std::string causes(const RunResult& run) {
  std::string text = std::to_string(run.summary.contacts.size());
  for (const Contact& contact : run.summary.contacts) {
    text += (&contact == &run.summary.contacts.front() ? ": " : ", ") + std::string(to_string(contact.cause));
  }
  return text;
}

void report_comparison(const Comparison& comparison, const std::vector<Eigen::Vector3d>& hexagon,
                       ExperimentReport& report) {
  report::MarkdownTable table({"method", "smallest true distance to the person, m", "contacts", "in contact, s",
                               "vertices reached", "s per vertex", "stopped, s",
                               "stopped with nothing within 0.4 m, s"});
  for (const auto& [method, run] : comparison.runs) {
    table.row({std::string(title(method)), report::fixed(run.summary.smallest_person_m, 3), causes(run),
               report::fixed(run.summary.in_contact_s, 2), std::to_string(run.vertices),
               run.vertices > 0 ? report::fixed(run.duration_s / run.summary.task_share, 3) : "-",
               report::fixed(run.summary.stopped_s, 2), report::fixed(run.summary.false_stop_s, 2)});
    report.figures()[comparison.sensor][std::string(key(method))] = figures_of(run);
  }
  report.paragraph("## " + comparison.sensor + " sensor");
  report.paragraph(table.text());
  report.paragraph(
      "robot_stood: when the contact began the touched point came towards the person at no more than 0.05 m/s. "
      "robot_came: it came faster. A vertex is reached when the end effector has passed it; \"s per vertex\" counts "
      "parts "
      "of a side, too.");
  report.picture("paths-" + comparison.sensor + ".png", picture_of_paths(comparison, hexagon),
                 "The end effector's path (red) and the hexagon (blue), seen along its normal.");
  report.picture(
      "over-time-" + comparison.sensor + ".png", picture_over_time(comparison),
      "Distances and repulsion over time. The letter's distances are those of points on the links' axes, the "
      "search's those of the links' surfaces, less what may have come nearer since the exposure. Lines that come "
      "later in the legend are drawn over those before.");
}

}  // namespace

void run_avoidance_experiment(const Options& options, ExperimentReport& report) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const double duration_s = frames_or(options, 360, 240) / kFrameRate_hz;
  const int width_px = width_or(options, 320, 160);
  const int real_px = width_or(options, 640, 160);
  std::vector<Comparison> comparisons;
  for (const std::string_view own : {"ideal", "kinect_v1"}) {
    const std::string_view sensor = sensor_or(options, own);
    if (comparisons.empty() || comparisons.front().sensor != sensor) {
      comparisons.push_back({std::string(sensor), sensor_settings(sensor, sensor == "ideal" ? width_px : real_px), {}});
    }
  }
  const AvoidanceMotion motion = carrying_person(avoidance_rig(2, width_px, "ideal"), duration_s, options.seed + 1);
  report.paragraph("A person carries a box to the arm and back (" + motion.name + ", " + report::fixed(duration_s) +
                   " s around the nearest time), while the end effector goes round a hexagon of radius 0.2 m at 0.40 "
                   "m/s. Two cameras of " +
                   std::to_string(width_px) + " x " + std::to_string(3 * width_px / 4) +
                   " pixels (real sensors: " + std::to_string(real_px) + " x " + std::to_string(3 * real_px / 4) +
                   ") in the letter's arrangement, 30 Hz, images 20 ms late, commands every 2 ms.");
  const std::vector<Eigen::Vector3d> hexagon = experiments::hexagon(model).vertices_world;
  std::size_t done = 0;
  const std::size_t total = comparisons.size() * kAllMethods.size();
  for (Comparison& comparison : comparisons) {
    RunSettings run;
    run.common = comparison.settings;
    run.duration_s = duration_s;
    run.sample_every = 10;
    run.seed = options.seed;
    for (const Method method : kAllMethods) {
      comparison.runs[method] = run_avoidance(method, model, motion, run);
      options.progress(++done, total);
    }
    report_comparison(comparison, hexagon, report);
    const RunResult& letter = comparison.runs[Method::letter_two];
    const RunResult& search = comparison.runs[Method::search];
    report.headline(comparison.sensor + " sensor: smallest true distance to the person " +
                    report::fixed(comparison.runs[Method::none].summary.smallest_person_m, 3) +
                    " m without avoidance, " +
                    report::fixed(comparison.runs[Method::letter_one].summary.smallest_person_m, 3) +
                    " m (letter, 1 camera), " + report::fixed(letter.summary.smallest_person_m, 3) +
                    " m (letter, 2 cameras), " + report::fixed(search.summary.smallest_person_m, 3) +
                    " m (search); vertices reached " + std::to_string(comparison.runs[Method::none].vertices) + ", " +
                    std::to_string(comparison.runs[Method::letter_one].vertices) + ", " +
                    std::to_string(letter.vertices) + ", " + std::to_string(search.vertices) + "; search with memory " +
                    report::fixed(comparison.runs[Method::search_memory].summary.smallest_person_m, 3) + " m, " +
                    std::to_string(comparison.runs[Method::search_memory].vertices) + " vertices.");
  }
}

}  // namespace depthgrid::experiments
