#include "depthgrid/experiments/camera_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "depthgrid/experiments/camera_images.hpp"
#include "depthgrid/experiments/distance_method.hpp"
#include "depthgrid/experiments/experiment_report.hpp"
#include "depthgrid/experiments/markdown_table.hpp"
#include "depthgrid/experiments/point_truth.hpp"
#include "depthgrid/experiments/processor_time.hpp"
#include "depthgrid/report/plot.hpp"

namespace depthgrid::experiments {

namespace {

using simulation::Motion;

constexpr int kMostCameras = 8;
constexpr std::array kMethods{Method::letter_hybrid, Method::letter, Method::corrected, Method::search};
constexpr std::size_t kLetterHybrid = 0;
constexpr std::size_t kCorrected = 2;
constexpr std::size_t kSearch = 3;
constexpr int kRepetitions = 3;   ///< of each timed evaluation in every frame
constexpr double kSpacing = 0.1;  ///< of the gray area's samples, metres

/// Points on the axes of the arm's capsules; the ball around each lies in the grown arm and touches its surface.
struct SurfacePoint {
  Eigen::Vector3d centre_world;
  double radius_m;
};
std::vector<SurfacePoint> surface_points(const ArmAtWork& arm, double padding_m) {
  std::vector<SurfacePoint> points;
  for (const simulation::Capsule& link : arm.capsules_world()) {
    for (const double share : {0.0, 0.5, 1.0}) {
      points.push_back({link.a_world + share * (link.b_world - link.a_world), link.radius_m + padding_m});
    }
  }
  return points;
}

/// Everything that one number of cameras needs.
struct Setup {
  Setup(int cameras, int width_px, const StagedCell& stage)
      : arrangement(simulation::arrangement(cameras, "ideal")),
        images(with_width(arrangement.rig, width_px), stage, RobotPixels::behind_unknown, {}) {
    result.cameras = cameras;
    for (const Method method : kMethods) {
      methods.emplace_back(method, images.rig(), arrangement);
      result.methods.push_back({std::string(to_string(method)), 0, 0, Deviation(DistanceMethod::kRho), 0, 0});
    }
    evaluations_s.resize(methods.size());
    updates_s.resize(methods.size());
  }

  simulation::Arrangement arrangement;
  CameraImages images;
  std::vector<DistanceMethod> methods;
  std::vector<std::vector<double>> evaluations_s;
  std::vector<std::vector<double>> updates_s;
  CameraCount result;
};

/// The truth of one instant.
struct Truth {
  std::vector<PointTruth::Nearest> control;
  std::vector<SurfacePoint> surface;
  std::vector<Eigen::Vector3d> centres_world;
  std::vector<PointTruth::Nearest> centres;
};

void ask(Setup& setup, std::size_t method, const StagedCell& stage, const Truth& truth, std::mt19937_64& engine) {
  CountedMethod& result = setup.result.methods[method];
  DistanceMethod& asked = setup.methods[method];
  double start_s = processor_time_s();
  asked.update(setup.images.frames());
  setup.updates_s[method].push_back(processor_time_s() - start_s);

  const auto points_world = stage.arm().points_world();
  std::vector<Proximity> answers(points_world.size());
  asked.evaluate(points_world, answers);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    result.deviation.add(answers[i], truth.control[i].distance_m);
  }
  // Other points every time, as a moving robot asks for them.
  std::uniform_real_distribution<double> aside_m(-0.02, 0.02);
  std::vector<Eigen::Vector3d> moved_world(points_world.begin(), points_world.end());
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    for (std::size_t i = 0; i < moved_world.size(); ++i) {
      moved_world[i] = points_world[i] + Eigen::Vector3d(aside_m(engine), aside_m(engine), aside_m(engine));
    }
    start_s = processor_time_s();
    asked.evaluate(moved_world, answers);
    setup.evaluations_s[method].push_back(processor_time_s() - start_s);
  }

  std::vector<Proximity> surface(truth.surface.size());
  asked.evaluate(truth.centres_world, surface);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (has_distance(surface[i]) && truth.centres[i].distance_m - truth.surface[i].radius_m > kFar) {
      ++result.far;
      result.pockets += surface[i].distance_m - truth.surface[i].radius_m < kTouching ? 1 : 0;
    }
  }
}

std::string milliseconds(double seconds) { return fixed(1000 * seconds, seconds < 0.01 ? 2 : 1); }

double time_ratio(const std::vector<CameraCount>& counts, std::size_t method, std::size_t index) {
  return counts[index].methods[method].evaluation_s / counts[1].methods[method].evaluation_s;
}

report::Canvas draw(const std::vector<CameraCount>& counts) {
  report::Plot time{"time of an evaluation of nine points, two cameras = 1", "cameras", "ratio", false, false, {}};
  report::Plot left{"what is left", "cameras", "share (%)", false, false, {}};
  report::Series linear{"proportional to the cameras", {}, {}, false, true};
  for (std::size_t method = 0; method < kMethods.size(); ++method) {
    report::Series& series = time.series.emplace_back();
    series.label = counts[0].methods[method].label;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      series.x.push_back(counts[i].cameras);
      series.y.push_back(time_ratio(counts, method, i));
    }
  }
  report::Series gray{"gray area, workspace", {}, {}};
  report::Series near_arm{"gray area, within 0.4 m of the arm", {}, {}};
  report::Series pockets{"pockets at the robot (search)", {}, {}};
  report::Series false_obstacles{"false obstacles (search)", {}, {}};
  for (const CameraCount& count : counts) {
    const CountedMethod& search = count.methods[kSearch];
    linear.x.push_back(count.cameras);
    linear.y.push_back(0.5 * count.cameras);
    for (report::Series* series : {&gray, &near_arm, &pockets, &false_obstacles}) {
      series->x.push_back(count.cameras);
    }
    gray.y.push_back(100 * count.gray.share());
    near_arm.y.push_back(100 * count.gray.share_near());
    pockets.y.push_back(100.0 * static_cast<double>(search.pockets) /
                        static_cast<double>(std::max<std::size_t>(1, search.far)));
    false_obstacles.y.push_back(100 * search.deviation.false_obstacles());
  }
  time.series.push_back(std::move(linear));
  left.series = {gray, near_arm, pockets, false_obstacles};
  report::Canvas canvas(880, 700);
  draw_plot(canvas, {10, 0, 860, 340}, time);
  draw_plot(canvas, {10, 350, 860, 340}, left);
  return canvas;
}

std::string time_table(const std::vector<CameraCount>& counts) {
  std::vector<std::string> head{"cameras"};
  for (const CountedMethod& method : counts[0].methods) {
    head.push_back(method.label + ", ms");
    head.push_back("to two cameras");
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(std::to_string(counts[i].cameras));
    for (std::size_t method = 0; method < kMethods.size(); ++method) {
      row.push_back(milliseconds(counts[i].methods[method].evaluation_s));
      row.push_back(fixed(time_ratio(counts, method, i), 2));
    }
  }
  return markdown_table(head, rows);
}

std::string pockets_text(const CountedMethod& method) {
  return percent(static_cast<double>(method.pockets) / static_cast<double>(std::max<std::size_t>(1, method.far)));
}

std::string left_table(const std::vector<CameraCount>& counts) {
  std::vector<std::vector<std::string>> rows;
  for (const CameraCount& count : counts) {
    const CountedMethod& search = count.methods[kSearch];
    const CountedMethod& letter = count.methods[kLetterHybrid];
    rows.push_back({std::to_string(count.cameras), percent(count.gray.share()), percent(count.gray.share_near()),
                    pockets_text(letter), pockets_text(search), percent(letter.deviation.false_obstacles()),
                    percent(search.deviation.false_obstacles()), percent(letter.deviation.overestimates()),
                    percent(search.deviation.overestimates())});
  }
  return markdown_table(
      {"cameras", "gray, workspace", "gray, within 0.4 m of the arm", "pockets, letter", "pockets, search",
       "> 100 mm too near, letter", "the same, search", "> 10 mm too far, letter", "the same, search"},
      rows);
}

}  // namespace

LinearFit linear_fit(const std::vector<CameraCount>& counts, std::size_t method) {
  std::vector<std::pair<double, double>> points;
  for (const CameraCount& count : counts) {
    if (count.cameras >= 2) {
      points.emplace_back(count.cameras, count.methods[method].evaluation_s);
    }
  }
  const auto n = static_cast<double>(points.size());
  double x_mean = 0;
  double y_mean = 0;
  for (const auto& [x, y] : points) {
    x_mean += x / n;
    y_mean += y / n;
  }
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (const auto& [x, y] : points) {
    xx += (x - x_mean) * (x - x_mean);
    xy += (x - x_mean) * (y - y_mean);
    yy += (y - y_mean) * (y - y_mean);
  }
  const double slope_s = xy / xx;
  return {y_mean - slope_s * x_mean, slope_s, yy > 0 ? xy * xy / (xx * yy) : 1.0};
}

std::vector<CameraCount> measure_camera_counts(const Options& options) {
  simulation::PersonStage place;
  place.robot_world = {0, -0.15, 0.65};
  StagedCell stage(Motion::reach, place, options.seed);
  const int width_px = width_or(options, 640, 320);
  const int frames = frames_or(options, 16, 8);
  std::vector<Setup> setups;
  for (int cameras = 1; cameras <= kMostCameras; ++cameras) {
    setups.emplace_back(cameras, width_px, stage);
  }
  PointTruth control_truth(stage.cell(), stage.arm().points_world().size());
  PointTruth surface_truth(stage.cell(), surface_points(stage.arm(), 0).size());
  std::mt19937_64 engine(options.seed);
  for (int frame = 0; frame < frames; ++frame) {
    stage.move_to(stage.person().duration_s() * (frame + 0.5) / frames);
    Truth truth;
    truth.control = control_truth.distances(stage.cell(), stage.arm().points_world());
    truth.surface = surface_points(stage.arm(), setups.front().images.padding_m());
    for (const SurfacePoint& point : truth.surface) {
      truth.centres_world.push_back(point.centre_world);
    }
    truth.centres = surface_truth.distances(stage.cell(), truth.centres_world);
    for (Setup& setup : setups) {  // all of them in every frame: what slows the machine down slows them all
      setup.images.take(stage, static_cast<std::uint64_t>(frame));
      setup.result.gray.add(gray_area(stage, setup.images, setup.arrangement, kSpacing));
      for (std::size_t method = 0; method < kMethods.size(); ++method) {
        ask(setup, method, stage, truth, engine);
      }
      options.progress(static_cast<std::size_t>(frame) * kMostCameras + static_cast<std::size_t>(setup.result.cameras),
                       static_cast<std::size_t>(frames) * kMostCameras);
    }
  }
  std::vector<CameraCount> counts;
  for (Setup& setup : setups) {
    for (std::size_t method = 0; method < kMethods.size(); ++method) {
      setup.result.methods[method].evaluation_s = quantile(std::move(setup.evaluations_s[method]), 0.5);
      setup.result.methods[method].update_s = quantile(std::move(setup.updates_s[method]), 0.5);
    }
    counts.push_back(std::move(setup.result));
  }
  return counts;
}

void run_camera_count(const Options& options, ExperimentReport& report) {
  report.paragraph(
      "One to eight cameras: the letter's first one; its two; from three on a circle around the robot. A person "
      "reaches "
      "for the moving arm, sensors are ideal, the space behind the robot counts as unknown. The letter states that its "
      "computations grow linearly with the number of cameras.");
  const std::vector<CameraCount> counts = measure_camera_counts(options);
  const std::size_t last = counts.size() - 1;
  std::string growth = "From two to eight cameras the time of an evaluation grows";
  for (const std::size_t method : {kLetterHybrid, kCorrected, kSearch}) {
    growth += std::string(method == kLetterHybrid ? " " : ", ") + fixed(time_ratio(counts, method, last), 2) +
              " times (" + counts[last].methods[method].label + ", a straight line explains " +
              percent(linear_fit(counts, method).r_squared, 0) + " of its variance)";
  }
  report.headline(growth + ".");
  report.headline("Within 0.4 m of the arm the gray area falls from " + percent(counts[0].gray.share_near()) +
                  " with one camera to " + percent(counts[1].gray.share_near()) + " with two and " +
                  percent(counts[last].gray.share_near()) +
                  " with eight; points of the robot that touch a pocket from " +
                  pockets_text(counts[0].methods[kSearch]) + " to " + pockets_text(counts[1].methods[kSearch]) +
                  " and " + pockets_text(counts[last].methods[kSearch]) + ".");
  report.picture("cameras.png", draw(counts),
                 "Above: processor time, medians of one run. Below: space that no camera has seen free, points of the "
                 "robot that read contact though nothing is within 0.1 m, control points whose answer is more than 100 "
                 "mm too near.");
  report.paragraph("Processor time of an evaluation of nine control points, new points every time:");
  report.paragraph(time_table(counts));
  report.paragraph(
      "With one camera the nearest obstacle is the robot's own shadow, so the scan ends early: straight lines are "
      "fitted "
      "from two cameras on.");
  report.paragraph(left_table(counts));
  report.paragraph(
      "*pockets*: points of the robot's surface (grown by the padding of its removal) that read less than 10 mm though "
      "nothing is within 100 mm.");
  for (const CameraCount& count : counts) {
    auto& json = report.figures()["cameras"][std::to_string(count.cameras)];
    json["gray_share"] = count.gray.share();
    json["gray_share_near_arm"] = count.gray.share_near();
    for (const CountedMethod& method : count.methods) {
      auto& figures = json[method.label];
      figures["evaluation_s"] = method.evaluation_s;
      figures["update_s"] = method.update_s;
      figures["far_surface_points"] = method.far;
      figures["pockets"] = method.pockets;
      figures["distances"] = method.deviation.json();
    }
  }
  for (std::size_t method = 0; method < kMethods.size(); ++method) {
    const LinearFit fit = linear_fit(counts, method);
    report.figures()["linear_fit"][counts[0].methods[method].label] = {
        {"offset_s", fit.offset_s}, {"slope_s_per_camera", fit.slope_s}, {"r_squared", fit.r_squared}};
  }
}

}  // namespace depthgrid::experiments
