#include "lab/experiments/shadow/shadow.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/stage/comparison_picture.hpp"
#include "lab/experiments/stage/rig_width.hpp"
#include "lab/experiments/stage/two_views.hpp"
#include "report/number_text.hpp"

namespace depthgrid::experiments {

namespace {

using simulation::Motion;

std::vector<Candidate> shadow_candidates(const Options& options) {
  constexpr auto kBackground = RobotPixels::background;
  const std::vector<std::size_t> one{kFirstCamera};
  const std::vector<std::size_t> two{kFirstCamera, kOppositeCamera};
  const std::vector<std::size_t> two_aside{kFirstCamera, kAsideCamera};
  const std::vector<std::size_t> three{kFirstCamera, kOppositeCamera, kAsideCamera};
  std::vector<Candidate> all{
      {"letter, 1 camera, robot = background", EvaluationMethod::letter, one, kBackground},
      {"letter, 2 cameras, robot = background", EvaluationMethod::letter, two, kBackground},
      {"corrected, 1 camera, robot = background", EvaluationMethod::corrected, one, kBackground},
      {"corrected, 2 cameras, robot = background", EvaluationMethod::corrected, two, kBackground},
      {"search, 1 camera, robot = background", EvaluationMethod::search, one, kBackground},
      {"search, 2 cameras, robot = background", EvaluationMethod::search, two, kBackground},
      {"letter, 1 camera", EvaluationMethod::letter, one},
      {"letter, 2 cameras", EvaluationMethod::letter, two},
      {"search, 1 camera", EvaluationMethod::search, one},
      {"search, 2 cameras", EvaluationMethod::search, two},
      {"search, 2 cameras, second aside", EvaluationMethod::search, two_aside},
      {"letter, 3 cameras", EvaluationMethod::letter, three},
      {"corrected, 3 cameras", EvaluationMethod::corrected, three},
      {"search, 3 cameras", EvaluationMethod::search, three},
  };
  if (options.sensor) {
    constexpr auto kThin = RobotPixels::thin_layer;
    all.push_back({"search with memory, 1 camera", EvaluationMethod::search_memory, one, kThin});
    all.push_back({"search with memory, 2 cameras", EvaluationMethod::search_memory, two, kThin});
    all.push_back({"search with memory, 3 cameras", EvaluationMethod::search_memory, three, kThin});
  }
  return all;
}

// Their places in the list.
constexpr std::size_t kShadowLetterOne = 0;
constexpr std::size_t kShadowLetterTwo = 1;
constexpr std::size_t kShadowSearchTwo = 5;
constexpr std::size_t kShadowLetterTwoUnknown = 7;
constexpr std::size_t kShadowSearchTwoUnknown = 9;
constexpr std::size_t kShadowSearchThree = 13;
constexpr std::size_t kShadowMemoryTwo = 15;  ///< where a sensor is given
constexpr std::size_t kShadowMemoryThree = 16;

constexpr double kStep = 0.05;   ///< seconds between the instants that are looked at for the shadow
constexpr double kBefore = 1.5;  ///< seconds of the motion that are looked at before and after the shadow

/// When the person hides the arm from the first camera, and a little more.
struct Window {
  double begin_s = 0;
  double end_s = 0;
};
Window shadow_window(StagedCell& stage, const Eigen::Vector3d& camera_world) {
  Window window{std::numeric_limits<double>::infinity(), 0};
  for (int step = 0; step * kStep <= stage.person().duration_s(); ++step) {
    const double time_s = step * kStep;
    stage.move_to(time_s);
    if (points_behind_person(stage, camera_world) > 0) {
      window = {std::min(window.begin_s, time_s), time_s};
    }
  }
  if (!(window.begin_s <= window.end_s)) {
    return {0, stage.person().duration_s()};
  }
  return {std::max(0.0, window.begin_s - kBefore), std::min(stage.person().duration_s(), window.end_s + kBefore)};
}

/// How much too near the answers of a candidate are in all, metres.
double too_near_m(const Instant& instant, std::size_t candidate) {
  double sum_m = 0;
  for (std::size_t i = 0; i < instant.truth.size(); ++i) {
    sum_m += std::min(instant.truth[i].distance_m, DistanceMethod::kRho) - instant.answers[candidate][i].distance_m;
  }
  return sum_m;
}

/// The instant of the worst shadow, as camera 1 sees it, and the way the smallest distance went.
void draw_shadow(const std::vector<Instant>& instants, StagedCell& stage, MethodComparison& comparison,
                 ExperimentReport& report) {
  const auto worst = std::max_element(instants.begin(), instants.end(), [](const Instant& a, const Instant& b) {
    return too_near_m(a, kShadowLetterOne) < too_near_m(b, kShadowLetterOne);
  });
  stage.move_to(worst->time_s);
  comparison.retake(stage, *worst);
  const Instant& instant = *worst;
  const CameraImages& images = comparison.images(RobotPixels::behind_unknown);
  const auto tile = [&](const char* title, std::size_t camera, std::size_t candidate) {
    return answer_tile(title, images, camera, instant, candidate);
  };
  report::Plot plot{"smallest distance of the nine points", "time (s)", "m", false, false, {}};
  plot.series.push_back(smallest_truth(instants, DistanceMethod::kRho));
  plot.series.push_back(smallest_answers(instants, kShadowLetterOne, "letter, 1 camera *"));
  plot.series.push_back(smallest_answers(instants, kShadowLetterTwo, "letter, 2 cameras *"));
  plot.series.push_back(smallest_answers(instants, kShadowSearchTwo, "search, 2 cameras *"));
  plot.series.push_back(smallest_answers(instants, kShadowSearchTwoUnknown, "search, 2 cameras"));
  plot.series.push_back(smallest_answers(instants, kShadowSearchThree, "search, 3 cameras"));
  if (comparison.remembers()) {
    plot.series.push_back(smallest_answers(instants, kShadowMemoryTwo, "search with memory, 2 cameras"));
    plot.series.push_back(smallest_answers(instants, kShadowMemoryThree, "search with memory, 3 cameras"));
  }
  report.picture("shadow.png",
                 draw_comparison({tile("camera 1: letter, it alone *", kFirstCamera, kShadowLetterOne),
                                  tile("camera 1: letter, both *", kFirstCamera, kShadowLetterTwo),
                                  tile("camera 1: search, both *", kFirstCamera, kShadowSearchTwo),
                                  tile("camera 1: letter, both", kFirstCamera, kShadowLetterTwoUnknown),
                                  tile("camera 2: search, both", kOppositeCamera, kShadowSearchTwoUnknown),
                                  tile("camera aside: search, all three", kAsideCamera, kShadowSearchThree)},
                                 {plot}),
                 "Above: the instant with the largest false shadow. Points on the arm and lines to what each method "
                 "takes for the nearest obstacle; a ring: nothing within 0.4 m. *: robot = background. Below: the "
                 "whole motion.");
}

}  // namespace

GroupedDeviations measure_shadow(const Options& options, ExperimentReport* pictures) {
  const simulation::Arrangement arrangement = two_views(sensor_or(options, "ideal"));
  const Rig rig = with_width(arrangement.rig, width_or(options, 640, 320));
  StagedCell stage(Motion::arm_between, stage_around_the_wrist(), options.seed);
  MethodComparison comparison(stage, rig, arrangement, shadow_candidates(options), {.seed = options.seed});
  const Window window = shadow_window(stage, rig.cameras.front().T_world_camera.translation());
  GroupedInstants measured = measure_groups(
      stage, comparison, {window.begin_s, window.end_s, frames_or(options, 100, 40)}, &StagedCell::move_to,
      [](const Instant& instant) { return instant.points_behind_person > 0; }, options.progress);
  if (pictures != nullptr) {
    draw_shadow(measured.instants, stage, comparison, *pictures);
  }
  return std::move(measured.figures);
}

void run_shadow(const Options& options, ExperimentReport& report) {
  report.paragraph(
      "A person stands aside and holds an arm into the line of sight from camera 1 to the robot, as in Figs. 8 and 12 "
      "of the letter. The second camera stands 4 m from the first, either aside (123 degrees around the robot) or "
      "opposite; the letter states the 4 m only. Sensor: " +
      std::string(sensor_or(options, "ideal")) +
      "; the arm moves. Distances from nine points on its axis up to 0.4 m, beside the real ones.");
  const GroupedDeviations figures = measure_shadow(options, &report);
  const auto false_share = [&](std::size_t candidate) {
    return report::percent(figures.chosen[candidate].deviation.false_obstacles());
  };
  report.headline("The person is never nearer to the arm than " + report::fixed(figures.person_to_arm_m, 2) +
                  " m. While a part of the arm is hidden from camera 1, the letter's method has a false obstacle (an "
                  "answer more than 100 mm too near) at " +
                  false_share(kShadowLetterOne) + " of the points with this camera alone and at " +
                  false_share(kShadowLetterTwo) + " with two, where the robot's pixels count as background.");
  report.headline("Where the space behind the robot counts as unknown, the search still has one at " +
                  false_share(kShadowSearchTwoUnknown) + " with two opposite cameras and at " +
                  false_share(kShadowSearchThree) + " with three.");
  if (options.sensor) {
    report.headline("With what is declared for the sensor and a memory it has one at " + false_share(kShadowMemoryTwo) +
                    " and at " + false_share(kShadowMemoryThree) + ".");
  }
  report_groups(figures, "While the person hides a control point from camera 1:", "in_shadow", report);
  report.paragraph(
      "*robot = background*: pixels of the robot are replaced by the empty room in all images, as if nothing could "
      "stand behind it; the letter's figures look like that. The other rows take the space behind the robot for "
      "unknown. With one camera that alone is an obstacle at nearly every point; with two, wherever the two shadows of "
      "the robot, or one of them and the person's, overlap.");
}

}  // namespace depthgrid::experiments
