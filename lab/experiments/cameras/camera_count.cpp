#include "lab/experiments/cameras/camera_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include "lab/experiments/stage/camera_images.hpp"
#include "lab/experiments/stage/distance_method.hpp"
#include "lab/experiments/stage/point_truth.hpp"
#include "lab/experiments/stage/rig_width.hpp"
#include "lab/measure/clocks.hpp"
#include "report/statistics.hpp"

namespace depthgrid::experiments {

namespace {

using simulation::Motion;

constexpr int kMaxCameras = 8;
constexpr std::array kTimedMethods{EvaluationMethod::letter_hybrid, EvaluationMethod::letter,
                                   EvaluationMethod::corrected, EvaluationMethod::search,
                                   EvaluationMethod::search_memory};  // the last where a sensor is given
/// Timed evaluations in every frame: more of those that are over sooner.
constexpr std::array kRepetitions{3, 3, 1, 20, 20};
constexpr int kCountedBefore = 15;  ///< images at 30 Hz that a memory sees before each instant
constexpr double kCountedFrame_s = 1.0 / 30;
constexpr double kSpacing = 0.1;  ///< of the gray area's samples, metres

/// Points on the axes of the arm's capsules; the ball around each lies in the grown arm and touches its surface.
struct SurfacePoint {
  Eigen::Vector3d centre_world;
  double radius_m;
};
std::vector<SurfacePoint> surface_points(const ArmAtWork& arm, double padding_m) {
  std::vector<SurfacePoint> points;
  for (const Capsule& link : arm.capsules_world()) {
    for (const double share : {0.0, 0.5, 1.0}) {
      points.push_back({link.a + share * (link.b - link.a), link.radius_m + padding_m});
    }
  }
  return points;
}

/// Everything that one number of cameras needs.
struct Setup {
  Setup(int cameras, int width_px, const StagedCell& stage, const Options& options)
      : arrangement(simulation::arrangement(cameras, sensor_or(options, "ideal"))),
        images(with_width(arrangement.rig, width_px), stage, RobotPixels::behind_unknown, {.seed = options.seed}) {
    result.cameras = cameras;
    if (options.sensor) {
      thin.emplace(images.rig(), stage, RobotPixels::thin_layer, simulation::SensorGroupSettings{.seed = options.seed});
    }
    for (const EvaluationMethod method : kTimedMethods) {
      if (method == EvaluationMethod::search_memory && !thin) {
        continue;
      }
      methods.emplace_back(method, images.rig(), arrangement);
      result.methods.push_back({std::string(to_string(method)), 0, 0, Deviation(DistanceMethod::kRho), 0, 0});
    }
    evaluations_s.resize(methods.size());
    updates_s.resize(methods.size());
  }

  simulation::Arrangement arrangement;
  [[nodiscard]] const CameraImages& images_of(std::size_t method) const {
    return method == kCountedMemory ? *thin : images;
  }

  CameraImages images;
  std::optional<CameraImages> thin;  ///< for the memory
  std::vector<DistanceMethod> methods;
  std::vector<std::vector<double>> evaluations_s;
  std::vector<std::vector<double>> updates_s;
  CameraCount result;
};

/// The truth of one instant.
struct Truth {
  double person_to_arm_m = 0;
  std::vector<PointTruth::Nearest> control;
  std::vector<SurfacePoint> surface;
  std::vector<Eigen::Vector3d> centres_world;
  std::vector<PointTruth::Nearest> centres;
};

/// What all instants of a stage are asked for.
class Truths {
 public:
  explicit Truths(const StagedCell& stage)
      : cell_(stage.cell()),
        control_(stage.cell(), stage.arm().points_world().size()),
        surface_(stage.cell(), surface_points(stage.arm(), 0).size()) {}

  /// The stage as it stands now, the arm's surface grown by `padding_m`.
  [[nodiscard]] Truth at(const StagedCell& stage, double padding_m) {
    Truth truth;
    cell_.update(stage.cell());
    truth.person_to_arm_m = cell_.between(stage.arm_body(), stage.person_body())->distance_m;
    truth.control = control_.distances(stage.cell(), stage.arm().points_world());
    truth.surface = surface_points(stage.arm(), padding_m);
    for (const SurfacePoint& point : truth.surface) {
      truth.centres_world.push_back(point.centre_world);
    }
    truth.centres = surface_.distances(stage.cell(), truth.centres_world);
    return truth;
  }

 private:
  workcell::CellTruth cell_;
  PointTruth control_;
  PointTruth surface_;
};

void ask(Setup& setup, std::size_t method, const StagedCell& stage, const Truth& truth, std::mt19937_64& engine) {
  CountedMethod& result = setup.result.methods[method];
  DistanceMethod& asked = setup.methods[method];
  double start_s = lab::processor_time_s();
  asked.update(setup.images_of(method).frames());
  setup.updates_s[method].push_back(lab::processor_time_s() - start_s);

  const auto points_world = stage.arm().points_world();
  std::vector<Proximity> answers(points_world.size());
  asked.evaluate(points_world, answers);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    // What of the person lies in the padding of the arm no method can see.
    if (truth.person_to_arm_m > setup.images_of(method).padding_m()) {
      result.deviation.add(answers[i], truth.control[i].distance_m);
    } else {
      result.deviation.leave_out();
    }
  }
  // Other points every time, as a moving robot asks for them.
  std::uniform_real_distribution<double> aside_m(-0.02, 0.02);
  std::vector<Eigen::Vector3d> moved_world(points_world.begin(), points_world.end());
  for (int repetition = 0; repetition < kRepetitions[method]; ++repetition) {
    for (std::size_t i = 0; i < moved_world.size(); ++i) {
      moved_world[i] = points_world[i] + Eigen::Vector3d(aside_m(engine), aside_m(engine), aside_m(engine));
    }
    start_s = lab::processor_time_s();
    asked.evaluate(moved_world, answers);
    setup.evaluations_s[method].push_back(lab::processor_time_s() - start_s);
  }

  if (method != kCountedLetter && method != kCountedSearch) {
    return;
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

/// Takes the times of all calls out of the setups.
std::vector<CameraCount> medians_of(std::vector<Setup>& setups) {
  std::vector<CameraCount> counts;
  for (Setup& setup : setups) {
    for (std::size_t method = 0; method < setup.methods.size(); ++method) {
      setup.result.methods[method].evaluation_s = report::quantile(std::move(setup.evaluations_s[method]), 0.5);
      setup.result.methods[method].update_s = report::quantile(std::move(setup.updates_s[method]), 0.5);
    }
    counts.push_back(std::move(setup.result));
  }
  return counts;
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
  StagedCell stage(Motion::reach, stage_around_the_wrist(), options.seed);
  const int width_px = width_or(options, 640, 320);
  const int frames = frames_or(options, 16, 8);
  std::vector<Setup> setups;
  for (int cameras = 1; cameras <= kMaxCameras; ++cameras) {
    setups.emplace_back(cameras, width_px, stage, options);
  }
  Truths truths(stage);
  std::mt19937_64 engine(options.seed);
  for (int frame = 0; frame < frames; ++frame) {
    const double time_s = stage.person().duration_s() * (frame + 0.5) / frames;
    for (int before = kCountedBefore; options.sensor && before > 0; --before) {
      const double earlier_s = time_s - before * kCountedFrame_s;
      stage.move_to(earlier_s);
      for (Setup& setup : setups) {
        const int number = (frame + 1) * 1000 + before;
        setup.thin->take(stage, static_cast<std::uint64_t>(number), earlier_s);
        setup.methods[kCountedMemory].update(setup.thin->frames());
      }
    }
    stage.move_to(time_s);
    const Truth truth = truths.at(stage, setups.front().images.padding_m());
    for (Setup& setup : setups) {  // all of them in every frame: what slows the machine down slows them all
      setup.images.take(stage, static_cast<std::uint64_t>(frame), time_s);
      if (setup.thin) {
        setup.thin->take(stage, static_cast<std::uint64_t>(frame), time_s);
      }
      setup.result.gray.add(gray_area(stage, setup.images, setup.arrangement, kSpacing));
      for (std::size_t method = 0; method < setup.methods.size(); ++method) {
        ask(setup, method, stage, truth, engine);
      }
      options.progress(static_cast<std::size_t>(frame) * kMaxCameras + static_cast<std::size_t>(setup.result.cameras),
                       static_cast<std::size_t>(frames) * kMaxCameras);
    }
  }
  return medians_of(setups);
}

}  // namespace depthgrid::experiments
