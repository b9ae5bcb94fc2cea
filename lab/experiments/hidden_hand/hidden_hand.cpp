#include "lab/experiments/hidden_hand/hidden_hand.hpp"

#include <algorithm>
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

constexpr std::size_t kPointBeforeHand = 4;  ///< the control point behind which the hand comes, in the arm's middle

std::vector<Candidate> hand_candidates(const Options& options) {
  constexpr auto kBackground = RobotPixels::background;
  const std::vector<std::size_t> one{kFirstCamera};
  const std::vector<std::size_t> two{kFirstCamera, kOppositeCamera};
  std::vector<Candidate> all{
      {"letter, 1 camera, robot = background", EvaluationMethod::letter, one, kBackground},
      {"letter, 2 cameras, robot = background", EvaluationMethod::letter, two, kBackground},
      {"search, 1 camera, robot = background", EvaluationMethod::search, one, kBackground},
      {"search, 2 cameras, robot = background", EvaluationMethod::search, two, kBackground},
      {"letter, 1 camera", EvaluationMethod::letter, one},
      {"corrected, 1 camera", EvaluationMethod::corrected, one},
      {"search, 1 camera", EvaluationMethod::search, one},
      {"letter, 2 cameras", EvaluationMethod::letter, two},
      {"corrected, 2 cameras", EvaluationMethod::corrected, two},
      {"search, 2 cameras", EvaluationMethod::search, two},
  };
  if (options.sensor) {
    constexpr auto kThin = RobotPixels::thin_layer;
    all.push_back({"search with memory, 1 camera", EvaluationMethod::search_memory, one, kThin});
    all.push_back({"search with memory, 2 cameras", EvaluationMethod::search_memory, two, kThin});
  }
  return all;
}

// Their places in the list.
constexpr std::size_t kHandLetterBlind = 0;
constexpr std::size_t kHandLetterTwoBlind = 1;
constexpr std::size_t kHandLetterOne = 4;
constexpr std::size_t kHandSearchOne = 6;
constexpr std::size_t kHandLetterTwo = 7;
constexpr std::size_t kHandSearchTwo = 9;
constexpr std::size_t kHandMemoryTwo = 11;  ///< where a sensor is given

/// Around the standing arm.
simulation::PersonStage stage_behind(const Eigen::Vector3d& robot_world, const Eigen::Vector3d& camera_world) {
  simulation::PersonStage stage;
  stage.robot_world = robot_world;
  stage.camera_world = camera_world;
  return stage;
}

/// The instant at which the hand is nearest, as each camera sees it, and the way the smallest distance went.
void draw_hidden_hand(const std::vector<Instant>& instants, StagedCell& stage, MethodComparison& comparison,
                      ExperimentReport& report) {
  const auto nearest = std::min_element(instants.begin(), instants.end(), [](const Instant& a, const Instant& b) {
    return a.person_to_arm_m < b.person_to_arm_m;
  });
  stage.move_person_to(nearest->time_s);
  comparison.retake(stage, *nearest);
  const Instant& instant = *nearest;
  const CameraImages& images = comparison.images(RobotPixels::behind_unknown);
  const auto tile = [&](const char* title, std::size_t camera, std::size_t candidate) {
    return answer_tile(title, images, camera, instant, candidate);
  };
  report::Plot plot{"distance from the control point that hides the hand", "time (s)", "m", false, false, {}};
  plot.series.push_back(point_truth(instants, kPointBeforeHand, DistanceMethod::kRho));
  plot.series.push_back(point_answers(instants, kHandLetterBlind, kPointBeforeHand, "letter, 1 camera *"));
  plot.series.push_back(point_answers(instants, kHandLetterOne, kPointBeforeHand, "letter, 1 camera"));
  plot.series.push_back(point_answers(instants, kHandSearchOne, kPointBeforeHand, "search, 1 camera"));
  plot.series.push_back(point_answers(instants, kHandLetterTwo, kPointBeforeHand, "letter, 2 cameras"));
  plot.series.push_back(point_answers(instants, kHandSearchTwo, kPointBeforeHand, "search, 2 cameras"));
  if (comparison.remembers()) {
    plot.series.push_back(point_answers(instants, kHandMemoryTwo, kPointBeforeHand, "search with memory, 2 cameras"));
  }
  report.picture(
      "hidden-hand.png",
      draw_comparison({tile("camera 1: letter, it alone *", kFirstCamera, kHandLetterBlind),
                       tile("camera 1: search, it alone", kFirstCamera, kHandSearchOne),
                       tile("camera 2: letter, both", kOppositeCamera, kHandLetterTwo)},
                      {plot}),
      "Above: the instant at which the hand is nearest. Points on the arm and lines to what each method takes "
      "for the nearest obstacle; a ring: nothing within 0.4 m. *: robot = background. Below: the control "
      "point behind which the hand comes, over the whole motion.");
}

}  // namespace

GroupedDeviations measure_hidden_hand(const Options& options, ExperimentReport* pictures) {
  const simulation::Arrangement arrangement = simulation::letter_arrangement(sensor_or(options, "ideal"));
  const Rig rig = with_width(arrangement.rig, width_or(options, 640, 320));
  const Eigen::Vector3d before_hand_world = ArmAtWork().points_world()[kPointBeforeHand];
  StagedCell stage(Motion::hand_behind_robot,
                   stage_behind(before_hand_world, rig.cameras.front().T_world_camera.translation()), options.seed);
  MethodComparison comparison(stage, rig, arrangement, hand_candidates(options), {.seed = options.seed});
  GroupedInstants measured = measure_groups(
      stage, comparison, {0, stage.person().duration_s(), frames_or(options, 100, 40)}, &StagedCell::move_person_to,
      [](const Instant& instant) { return instant.person_to_arm_m < kHandNear; }, options.progress);
  if (pictures != nullptr) {
    draw_hidden_hand(measured.instants, stage, comparison, *pictures);
  }
  return std::move(measured.figures);
}

void run_hidden_hand(const Options& options, ExperimentReport& report) {
  report.paragraph(
      "The arm stands. A person beyond it brings a hand to where the arm hides it from camera 1, as in Figs. 9 and 13 "
      "of the letter. The second camera stands opposite the first. Sensor: " +
      std::string(sensor_or(options, "ideal")) +
      ". Distances from nine points on the arm's axis up to 0.4 m, beside the real ones.");
  const GroupedDeviations figures = measure_hidden_hand(options, &report);
  const auto too_far = [&](std::size_t candidate) {
    const Deviation& deviation = figures.chosen[candidate].deviation;
    return report::percent(deviation.overestimates()) + " of the answers (" +
           report::fixed(1000 * deviation.largest_overestimate_m()) + " mm at most)";
  };
  report.headline(
      "The hand comes as near as " + report::fixed(figures.person_to_arm_m, 2) +
      " m to the arm. While it is near and the robot's pixels are taken for background, the letter's method is more "
      "than 10 mm too far in " +
      too_far(kHandLetterBlind) + " with camera 1 alone, in " + too_far(kHandLetterTwoBlind) +
      " with two cameras: the second one does not help. With the space behind the robot unknown the letter's method "
      "with two cameras is so in " +
      too_far(kHandLetterTwo) + ", the search with one in " + too_far(kHandSearchOne) + ", with two in " +
      too_far(kHandSearchTwo) + ".");
  report.headline(
      "With one camera and the space behind the robot unknown, the search has a false obstacle (more than "
      "100 mm too near) at " +
      report::percent(figures.otherwise[kHandSearchOne].deviation.false_obstacles()) +
      " of the points while nobody is near, with two cameras at " +
      report::percent(figures.otherwise[kHandSearchTwo].deviation.false_obstacles()) + ".");
  if (options.sensor) {
    report.headline("With what is declared for the sensor and a memory it has one at " +
                    report::percent(figures.otherwise[kHandMemoryTwo].deviation.false_obstacles()) +
                    " with two cameras, at " +
                    report::percent(figures.chosen[kHandMemoryTwo].deviation.false_obstacles()) +
                    " while the hand is near, where it is too far in " + too_far(kHandMemoryTwo) + ".");
  }
  report_groups(figures,
                "While the person is nearer than " + report::fixed(kHandNear, 2) + " m to the arm:", "hand_near",
                report);
  report.paragraph(
      "*robot = background*: pixels of the robot are replaced by the empty room in all images, as if nothing could "
      "stand behind it; then no further camera helps, because the first one claims to have seen the hand's place free. "
      "The other rows take the space behind the robot for unknown (the letter's case (iv)).");
}

}  // namespace depthgrid::experiments
