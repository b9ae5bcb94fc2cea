// How long the robot's interval in an image takes, one core: the LWR's eight capsules at random joint positions,
// 640x480, with the padding of a moving arm. Prints a table.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <random>
#include <vector>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_at_exposure.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "report/machine.hpp"

namespace depthgrid::lab {
namespace {

using robot::RobotModel;

/// Images of a room behind an arm, 16-bit as cameras deliver them; the content matters little, the reading of it does.
std::vector<std::uint16_t> image(std::mt19937_64& engine) {
  std::vector<std::uint16_t> units(640 * 480);
  std::uniform_int_distribution<int> depth(600, 4000);
  std::generate(units.begin(), units.end(), [&] { return static_cast<std::uint16_t>(depth(engine)); });
  return units;
}

void measure(const RobotModel& model, double distance_m, double time_error_s, bool with_reading, int poses,
             int repetitions) {
  std::mt19937_64 engine(1);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const PinholeCamera camera = from_opencv(640, 480, 525, 525, 319.5, 239.5);
  robot::JointHistory history(7, 2, 1.0, 0.0);
  robot::ExposureSettings settings;
  settings.removal.padding_m = 0.05;
  settings.time_error_s = time_error_s;
  settings.joint_speeds.assign(7, 0.5);
  robot::RobotAtExposure exposure({model}, history, camera, robot::link_capsules(model), settings);
  const std::vector<std::uint16_t> units = image(engine);
  const DepthView reading = depth_view(units, 640, 480, 0.001);
  Samples medians_ms;  // of each pose: one slow image is the machine's doing, a slow median the pose's
  double share = 0;
  for (int i = 0; i < poses; ++i) {
    std::vector<double> q;
    for (const robot::Joint& joint : model.joints()) {
      q.push_back(uniform(joint.lower, joint.upper));
    }
    history.add(i, q);
    const double turn = uniform(-3.1, 3.1);
    const Eigen::Vector3d target(0, 0, 0.5);
    const Pose T_world_camera = look_at(
        target + distance_m * Eigen::Vector3d(std::cos(turn), std::sin(turn), uniform(-0.3, 0.6)).normalized(), target);
    robot::ExposedRobot found;
    Samples times_ms;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      const Stopwatch watch;
      found = exposure.find(i, T_world_camera, with_reading ? &reading : nullptr);
      times_ms.add(1e3 * watch.elapsed_s());
    }
    medians_ms.add(times_ms.median());
    long robot_pixels = 0;
    for (int k = 0; k < 480 * 640; ++k) {
      robot_pixels += found.view.near_m[k] > 0 ? 1 : 0;
    }
    share += static_cast<double>(robot_pixels) / (640.0 * 480.0 * poses);
  }
  std::printf("| %.1f | %.0f | %s | %.0f %% | %.2f | %.2f |\n", distance_m, 1e3 * time_error_s,
              with_reading ? "yes" : "no", 100 * share, medians_ms.median(), medians_ms.largest());
  std::fflush(stdout);
}

struct RemovalOptions {
  int poses = 100;
  int repetitions = 20;
};

void measure_all(const RemovalOptions& options) {
  const RobotModel model = robot::kuka_lwr4();
  std::cout << report::machine_line() << "\n\n"
            << "| camera m | time error ms | with readings | pixels with robot | ms | slowest pose, ms |\n"
            << "|---|---|---|---|---|---|\n"
            << std::flush;
  for (const double distance_m : {1.0, 2.0, 3.0}) {
    for (const double time_error_s : {0.0, 0.05}) {
      for (const bool with_reading : {false, true}) {
        measure(model, distance_m, time_error_s, with_reading, options.poses, options.repetitions);
      }
    }
  }
}

}  // namespace

void add_robot_removal_command(CLI::App& app) {
  const auto options = std::make_shared<RemovalOptions>();
  CLI::App* const command = app.add_subcommand("robot-removal",
                                               "time of joint positions, kinematics, padding and the robot's interval "
                                               "in one 640x480 image, one core: some seconds");
  command->add_option("--poses", options->poses, "random joint positions a row")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--repetitions", options->repetitions, "images a pose")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->callback([options] { measure_all(*options); });
}

}  // namespace depthgrid::lab
