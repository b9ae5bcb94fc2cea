#include "lab/experiments/film/film.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/film/cell_view.hpp"
#include "lab/experiments/loop/avoidance_run.hpp"
#include "report/number_text.hpp"

namespace depthgrid::experiments {

namespace {

using Eigen::Vector3d;

constexpr int kEveryFrame = 3;  ///< of the cameras' frames
constexpr int kWidth = 480;     ///< of a side
constexpr int kHeight = 400;
constexpr double kBelow = 84;  ///< for the text
constexpr double kBetween = 8;
constexpr double kCube_m = 0.05;

const Vector3d kEye_world(2.35, 2.25, 1.75);
const Vector3d kTarget_world(0.0, 0.42, 0.42);
// What is drawn as haze: the arm's surroundings. Farther away much is unknown that does not matter here.
const Vector3d kHazeLow_world(-0.9, -0.4, -0.1);
const Vector3d kHazeHigh_world(0.9, 1.2, 1.35);

struct Side {
  Method method;
  const char* title;
};
constexpr std::array kSides{Side{Method::search, "a pixel without reading frees nothing"},
                            Side{Method::search_memory, "smallest obstacle 5 cm, and a memory"}};

/// What is shown of one instant of a run.
struct Moment {
  report::Raster view;
  std::vector<report::CanvasPoint> path;  ///< of the end effector, so far
  std::string says;
  std::int64_t vertices = 0;
};

/// Which cubes the answers take for possible obstacles: those whose middle is at distance 0 from one.
void ask(DistanceEvaluator& evaluator, double time_s, UnknownCubes& cubes) {
  std::vector<Capsule> points;
  for (std::size_t i = 0; i < cubes.unknown.size(); ++i) {
    points.push_back(Capsule::point(cubes.centre_world(i)));
  }
  std::vector<Answer> answers(points.size());
  evaluator.evaluate(points, time_s, answers);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    cubes.unknown[i] = answers[i].nearest.distance_m > 0.5 * kCube_m ? 0 : 1;
  }
}

std::vector<Moment> filmed(Method method, const robot::RobotModel& model, const AvoidanceMotion& motion,
                           RunSettings settings, const std::function<void()>& step, RunResult& result) {
  std::vector<Moment> moments;
  std::vector<report::CanvasPoint> path;
  std::optional<CellView> view;
  UnknownCubes cubes(kHazeLow_world, kHazeHigh_world, kCube_m);
  int frame = 0;
  settings.on_instant = [&](const RunInstant& instant) {
    if (!view) {
      view.emplace(instant.cell, kEye_world, kTarget_world, kWidth, kHeight);
    }
    path.push_back(view->at(instant.loop.report().end_effector_world));
    if (frame++ % kEveryFrame != 0) {
      return;
    }
    ask(instant.evaluator, instant.time_s, cubes);
    std::array<char, 192> text{};
    moments.push_back({view->draw(instant.cell, cubes), path,
                       std::string(avoidance::describe(instant.loop.report().reason, text)), instant.vertices});
    step();
  };
  result = run_avoidance(method, model, motion, settings);
  return moments;
}

/// The text in two lines that fit beneath a side.
std::array<std::string, 2> in_two_lines(const report::Canvas& canvas, const std::string& text, double size_px) {
  std::size_t end = text.size();
  while (end != std::string::npos && end > 0 && canvas.text_width_px(text.substr(0, end), size_px) > kWidth - 12) {
    end = text.rfind(' ', end - 1);
  }
  if (end == std::string::npos || end == text.size()) {
    return {text, ""};
  }
  return {text.substr(0, end), text.substr(end + 1)};
}

report::Canvas picture_of(const std::array<std::vector<Moment>, 2>& sides, std::size_t n) {
  report::Canvas canvas(static_cast<int>(2 * kWidth + kBetween), static_cast<int>(30 + kHeight + kBelow));
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Moment& moment = sides[i][n];
    const double left = static_cast<double>(i) * (kWidth + kBetween);
    const report::Rectangle area{left, 30, kWidth, kHeight};
    canvas.raster(area, moment.view);
    canvas.clip(area);
    std::vector<report::CanvasPoint> path;
    for (const report::CanvasPoint& at : moment.path) {
      path.push_back({left + at.x_px, 30 + at.y_px});
    }
    canvas.polyline(path, {report::Colour{0.84, 0.08, 0.30}, 2});
    canvas.unclip();
    canvas.text({left + 6, 20}, kSides[i].title, 16);
    const double below = 30 + kHeight;
    canvas.text({left + 6, below + 22}, std::to_string(moment.vertices) + " corners of the hexagon", 15);
    const std::array<std::string, 2> lines = in_two_lines(canvas, moment.says, 13);
    canvas.text({left + 6, below + 42}, lines[0], 13);
    canvas.text({left + 6, below + 60}, lines[1], 13);
  }
  canvas.text({2 * kWidth + kBetween - 6, 30 + kHeight + kBelow - 6}, "gray: not known free, may hold something", 13,
              report::kBlack, report::Align::right);
  canvas.text({2 * kWidth + kBetween - 6, 20},
              report::fixed(static_cast<double>(n) * kEveryFrame / kFrameRate_hz, 1) + " s", 15, report::kBlack,
              report::Align::right);
  return canvas;
}

}  // namespace

void run_film(const Options& options, ExperimentReport& report) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const double duration_s = frames_or(options, 360, 60) / kFrameRate_hz;
  RunSettings run;
  run.common = sensor_settings(sensor_or(options, "kinect_v1"), width_or(options, 640, 160));
  run.duration_s = duration_s;
  run.seed = options.seed;
  const AvoidanceMotion motion =
      carrying_person(avoidance_rig(2, run.common.width_px, "ideal"), duration_s, options.seed + 1);
  const auto moments = static_cast<std::size_t>(std::ceil(duration_s * kFrameRate_hz / kEveryFrame));
  std::size_t done = 0;
  std::array<std::vector<Moment>, 2> sides;
  std::array<RunResult, 2> results;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    sides[i] = filmed(
        kSides[i].method, model, motion, run, [&] { options.progress(++done, 2 * moments); }, results[i]);
    report.figures()[std::string(key(kSides[i].method))] = {{"vertices", results[i].vertices},
                                                            {"stopped_s", results[i].summary.stopped_s},
                                                            {"contacts", results[i].summary.contacts.size()}};
    report.headline(std::string(kSides[i].title) + ": " + std::to_string(results[i].vertices) +
                    " corners of the hexagon in " + report::fixed(duration_s, 1) + " s, stopped for " +
                    report::fixed(results[i].summary.stopped_s, 1) + " s.");
  }
  for (std::size_t n = 0; n < std::min(sides[0].size(), sides[1].size()); ++n) {
    report.frame(picture_of(sides, n));
  }
}

}  // namespace depthgrid::experiments
