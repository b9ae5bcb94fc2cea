// How long one control cycle takes: seven joints, the end effector and eight points of the body, one core. Kinematics
// and distances are not part of it. Prints a table.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <vector>

#include "control/cell.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "report/machine.hpp"

namespace depthgrid::control {
namespace {

struct Situation {
  const char* name;
  double away_m;  ///< of the sphere's centre from the middle of the task
};

/// The letter's task with a sphere that swings through the arm's front.
lab::Samples measure(const ControllerSettings& settings, double away_m, int cycles) {
  Controller controller(settings);
  controller.start(test::lwr_bent());
  PolygonTask task(test::lwr_hexagon());
  const Eigen::Vector3d middle = test::lwr_flange(test::lwr_bent()).p_world;
  lab::Samples times_us;
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
    const lab::Stopwatch watch;
    const CycleOutput output = controller.cycle(input);
    const double elapsed_us = 1e6 * watch.elapsed_s();
    if (k >= 0 && output.command.position_rad.size() > 0) {
      times_us.add(elapsed_us);
    }
  }
  return times_us;
}

void print_row(const char* saturation, const char* law, const Situation& situation, const lab::Samples& times_us) {
  std::printf("| %s | %s | %s | %.2f | %.2f | %.1f |\n", saturation, law, situation.name, times_us.median(),
              times_us.quantile(0.999), times_us.largest());
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

namespace depthgrid::lab {

void add_control_cycle_command(CLI::App& app) {
  const auto cycles = std::make_shared<int>(50000);
  CLI::App* const command =
      app.add_subcommand("control-cycle", "time of one control cycle, distances not included, one core: some seconds");
  command->add_option("--cycles", *cycles, "cycles in each situation")
      ->check(CLI::Range(10, 100000000))
      ->capture_default_str();
  command->callback([cycles] {
    std::cout << report::machine_line() << "\n\n"
              << "| saturation | body law | situation | median us | 99.9 % | maximum |\n|---|---|---|---|---|---|\n"
              << std::flush;
    control::measure_all(*cycles);
  });
}

}  // namespace depthgrid::lab
