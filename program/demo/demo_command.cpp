#include "program/demo/demo_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <limits>
#include <memory>
#include <sstream>
#include <vector>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/simulation/demo_scene.hpp"
#include "program/demo/demo_picture.hpp"
#include "program/output_check.hpp"

// NOLINTBEGIN(cppcoreguidelines-pro-type-vararg): printf lays out the table; streams would need a line a column

namespace depthgrid::program {

namespace {

/// An answer this much short of the true distance (both capped at rho) owes it to a shadow, not to the size of a cell.
constexpr double kShadowShortfall = 0.03;

std::vector<Frame> frames_of(const simulation::DemoScene& demo, const std::vector<simulation::View>& views) {
  std::vector<Frame> frames;
  for (const simulation::View& view : views) {
    const int width_px = view.depth_m.width_px();
    const int height_px = view.depth_m.height_px();
    Frame frame;
    frame.depth = depth_view(
        std::span(view.depth_m.data(), static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)),
        width_px, height_px);
    frame.robot = with_layer({view.robot_near_m.data(), view.robot_far_m.data(), width_px},
                             demo.rig.cameras[frames.size()].intrinsics, demo.robot_padding_m);
    frames.push_back(frame);
  }
  return frames;
}

/// The same question to the search: the grid's space, exact images of one instant.
views::Settings search_settings(const Rig& rig, const grid::DepthQuantisation& quantisation, double rho_m) {
  const grid::DepthGrid space(rig.cameras[0].intrinsics, quantisation);
  views::Settings settings;
  settings.space = views::FrustumSpace{0, space.d_min_m(), space.d_max_m()};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0.0};
  settings.margins.assign(rig.cameras.size(), CameraMargins{.sensor = {}, .smallest_obstacle_m = 0});
  settings.rho_m = rho_m;
  settings.v_max_m_s = 0.0;
  return settings;
}

std::unique_ptr<DistanceEvaluator> make_evaluator(const Rig& rig, const grid::DepthQuantisation& quantisation,
                                                  const std::string& method) {
  grid::EvaluationSettings settings;
  if (method == "search") {
    return std::make_unique<search::SearchEvaluator>(rig, search_settings(rig, quantisation, settings.rho_m));
  }
  settings.variant = method == "letter" ? grid::Variant::letter : grid::Variant::corrected;
  return std::make_unique<grid::GridEvaluator>(rig, 0, quantisation, settings);
}

/// Distances of all control points with the first `cameras` cameras of the demo.
std::vector<Proximity> evaluate(const simulation::DemoScene& demo, std::span<const Frame> frames, std::size_t cameras,
                                const grid::DepthQuantisation& quantisation, const std::string& method) {
  Rig rig = demo.rig;
  rig.cameras.resize(cameras);
  const auto evaluator = make_evaluator(rig, quantisation, method);
  (void)update_all(*evaluator, frames.first(cameras));  // the frames of the scene are complete
  std::vector<Capsule> points;
  points.reserve(demo.control_points_world.size());
  for (const Eigen::Vector3d& p_world : demo.control_points_world) {
    points.push_back(Capsule::point(p_world));
  }
  std::vector<Answer> found(points.size());
  evaluator->evaluate(points, 0, found);
  std::vector<Proximity> answers;
  answers.reserve(found.size());
  for (const Answer& answer : found) {
    answers.push_back(answer.nearest);
  }
  return answers;
}

std::string cell(const Proximity& answer) {
  std::ostringstream text;
  text << (answer.state == ProximityState::beyond_rho ? ">=" : "  ") << std::fixed << std::setprecision(0)
       << std::setw(4) << 1000 * answer.distance_m << "  " << to_string(answer.state);
  return text.str();
}

bool has_shadow_obstacle(const Proximity& answer, double true_m, double rho_m) {
  return has_distance(answer) && std::min(true_m, rho_m) - answer.distance_m > kShadowShortfall;
}

void print_closing(const std::vector<double>& true_m, const DemoAnswers& answers, double rho_m) {
  int shadowed = 0;
  int lost = 0;
  double farthest_above_m = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < true_m.size(); ++i) {
    const bool with_one = has_shadow_obstacle(answers.one_camera[i], true_m[i], rho_m);
    const bool with_two = has_shadow_obstacle(answers.two_cameras[i], true_m[i], rho_m);
    shadowed += with_one ? 1 : 0;
    lost += with_one && !with_two ? 1 : 0;
    for (const Proximity& answer : {answers.one_camera[i], answers.two_cameras[i]}) {
      if (has_distance(answer)) {
        farthest_above_m = std::max(farthest_above_m, answer.distance_m - true_m[i]);
      }
    }
  }
  std::printf(
      "\n%d of %zu points have a shadow obstacle with one camera; %d of them lose it with two\n"
      "(a shadow obstacle: an answer more than 30 mm short of the true distance).\n",
      shadowed, true_m.size(), lost);
  if (farthest_above_m > 0) {
    std::printf("The answer farthest above the true distance is %.1f mm above it.\n", 1000 * farthest_above_m);
  } else {
    std::printf("No answer is above the true distance; the nearest to it is %.1f mm below.\n",
                -1000 * farthest_above_m);
  }
}

}  // namespace

void run_demo(const DemoOptions& options) {
  if (!options.picture.empty()) {
    check_output_file(options.picture);
  }
  const simulation::DemoScene demo = simulation::demo_scene();
  std::vector<simulation::View> views;
  for (const RigCamera& camera : demo.rig.cameras) {
    views.push_back(demo.scene.render(camera.intrinsics, camera.T_world_camera, demo.robot_padding_m));
  }
  const std::vector<Frame> frames = frames_of(demo, views);

  const grid::DepthQuantisation quantisation;
  const double rho_m = grid::EvaluationSettings{}.rho_m;
  const DemoAnswers answers{evaluate(demo, frames, 1, quantisation, options.method),
                            evaluate(demo, frames, 2, quantisation, options.method)};

  std::printf(
      "A person, an arm and two depth cameras 4 m apart, by ray casting. Distances in mm from nine points on the\n"
      "arm's axis; surveillance radius %.0f mm; method %s.\n\n",
      1000 * rho_m, options.method.c_str());
  std::printf("point    x      y      z (m)    true    one camera             two cameras\n");
  std::vector<double> true_m;
  for (std::size_t i = 0; i < demo.control_points_world.size(); ++i) {
    const Eigen::Vector3d& p = demo.control_points_world[i];
    true_m.push_back(demo.scene.distance(p).distance_m);
    std::printf("%5zu %6.2f %6.2f %6.2f %9.0f    %-21s  %s\n", i + 1, p.x(), p.y(), p.z(), 1000 * true_m.back(),
                cell(answers.one_camera[i]).c_str(), cell(answers.two_cameras[i]).c_str());
  }
  print_closing(true_m, answers, rho_m);
  if (!options.picture.empty()) {
    write_demo_picture(options.picture, demo, frames, answers, quantisation);
    std::printf("Picture: %s\n", printable(options.picture).c_str());
  }
}

void add_demo_command(CLI::App& app) {
  const auto options = std::make_shared<DemoOptions>();
  CLI::App* const command =
      app.add_subcommand("demo", "distances in an embedded scene with one camera and with two; no data needed");
  command
      ->add_option(
          "--method,--variant", options->method,
          "letter: as printed, errors included; corrected: its grid, a lower bound; search: a tight lower bound")
      ->check(CLI::IsMember({"letter", "corrected", "search"}))
      ->capture_default_str();
  command->add_option("--picture", options->picture, "also write a picture of the scene to this PNG file");
  command->footer("Example:\n  depthgrid demo --picture demo.png");
  command->callback([options] { run_demo(*options); });
}

}  // namespace depthgrid::program

// NOLINTEND(cppcoreguidelines-pro-type-vararg)
