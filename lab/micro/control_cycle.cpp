// How long one control cycle takes: seven joints, the end effector and eight points of the body, one core. Kinematics
// and distances are not part of it. Prints a table.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <vector>

#include "control/cell.hpp"
#include "lab/machine.hpp"

namespace depthgrid::control {
namespace {

struct Situation {
  const char* name;
  double away_m;  ///< of the sphere's centre from the middle of the task
};

struct Row {
  double median_us, p999_us, largest_us;
};

/// The letter's task with a sphere that swings through the arm's front.
Row measure(const ControllerSettings& settings, double away_m, int cycles) {
  Controller controller(settings);
  controller.start(test::lwr_bent());
  PolygonTask task(test::lwr_hexagon());
  const Eigen::Vector3d middle = test::lwr_flange(test::lwr_bent()).p_world;
  std::vector<double> times_us;
  std::vector<BodyPoint> body;
  for (int k = -1000; k < cycles; ++k) {
    const double t = settings.period_s * k;
    const test::Sphere sphere{middle + Eigen::Vector3d(away_m, 0.3 * std::sin(t), 0.2 * std::sin(0.7 * t)), 0.05};
    const JointVector q = controller.last().position_rad;
    const test::LwrPoint tip = test::lwr_flange(q);
    body.clear();
    for (const test::LwrPoint& point : test::lwr_body(q)) {
      body.push_back({point.jacobian, obstacle_of(test::sphere_proximity(point.p_world, sphere))});
    }
    const Proximity at_tip = test::sphere_proximity(tip.p_world, sphere);
    const CycleInput input{.task = {tip.jacobian, task.desired_velocity(tip.p_world)},
                           .end_effector = obstacle_of(at_tip, at_tip.direction_world),
                           .body = body,
                           .further_tasks = {}};
    const auto start = std::chrono::steady_clock::now();
    const CycleOutput output = controller.cycle(input);
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    if (k >= 0 && output.command.position_rad.size() > 0) {
      times_us.push_back(elapsed.count());
    }
  }
  std::sort(times_us.begin(), times_us.end());
  const auto at = [&](double part) {
    return times_us[static_cast<std::size_t>(part * static_cast<double>(times_us.size() - 1))];
  };
  return {at(0.5), at(0.999), times_us.back()};
}

void print_row(const char* saturation, const char* law, const Situation& situation, const Row& row) {
  std::printf("| %s | %s | %s | %.2f | %.2f | %.1f |\n", saturation, law, situation.name, row.median_us, row.p999_us,
              row.largest_us);
  std::fflush(stdout);
}

void measure_all(int cycles) {
  ControllerSettings settings = test::lwr_settings();
  for (const Situation& situation : {Situation{"nothing near", 100.0}, Situation{"sphere at the tip", 0.2},
                                     Situation{"sphere through the arm", -0.3}}) {
    settings.saturation.variant = SaturationVariant::basic;
    settings.body.law = BodyLaw::risk;
    print_row("basic", "risk", situation, measure(settings, situation.away_m, cycles));
    settings.saturation.variant = SaturationVariant::optimal;
    print_row("optimal", "risk", situation, measure(settings, situation.away_m, cycles));
    settings.body.law = BodyLaw::approach_row;
    print_row("optimal", "approach_row", situation, measure(settings, situation.away_m, cycles));
  }
}

}  // namespace
}  // namespace depthgrid::control

int main(int argc, char** argv) {
  CLI::App app{"Time of one control cycle, one core."};
  int cycles = 50000;
  app.add_option("--cycles", cycles, "cycles in each situation")
      ->check(CLI::Range(10, 100000000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::cout << depthgrid::lab::machine_line() << "\n\n"
            << "| saturation | body law | situation | median us | 99.9 % | maximum |\n|---|---|---|---|---|---|\n"
            << std::flush;
  depthgrid::control::measure_all(cycles);
  return 0;
}
