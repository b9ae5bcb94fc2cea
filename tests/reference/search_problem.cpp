#include "reference/search_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace depthgrid::reference {
namespace {

using Eigen::Vector3d;

/// One to eight cameras, few more often than many.
int draw_cameras(Random& random) {
  constexpr std::array<int, 16> kCounts{1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 4, 4, 5, 6, 7, 8};
  return kCounts[static_cast<std::size_t>(random.integer(0, 15))];
}

CameraMargins draw_margins(Random& random, bool lateral) {
  CameraMargins margins;
  margins.sensor.constant_m = random.uniform(0, 0.01);
  margins.sensor.linear = random.chance(0.3) ? random.uniform(0, 0.003) : 0.0;
  margins.sensor.quadratic_per_m = random.uniform(0, 0.002);
  margins.sensor.lateral_px = lateral ? random.integer(0, 2) : 0;
  // Some cameras without pose error beside others with it.
  const bool with_error = random.chance(0.8);
  margins.translation_m = random.uniform(0, with_error ? 0.01 : 0.0);
  margins.rotation_rad = random.uniform(0, with_error ? 0.004 : 0.0);
  margins.half_exposure_s = random.uniform(0, with_error ? 0.008 : 0.0);
  margins.time_uncertainty_s = random.uniform(0, with_error ? 0.001 : 0.0);
  return margins;
}

views::BoxSpace draw_box(Random& random) {
  const Vector3d centre = random.in_cube(0.3);
  Vector3d half;
  for (double& side_m : half) {
    side_m = random.chance(0.5) ? random.uniform(1.0, 2.5) : random.uniform(0.2, 1.0);
  }
  return {centre - half, centre + half};
}

Capsule draw_primitive(Random& random, Shape shape, const Vector3d& centre) {
  const Vector3d along = random.uniform(0.02, 0.3) * random.direction();
  const double radius_m = random.chance(0.1) ? 0.0 : random.uniform(0.005, 0.12);
  switch (shape) {
    case Shape::point:
      return Capsule::point(centre);
    case Shape::sphere:
      return Capsule::sphere(centre, radius_m);
    default:
      return Capsule{centre - along, centre + along, radius_m};
  }
}

/// Most of them in W and clear of O, among the obstacles, beside the cameras or at the border of the views.
void draw_primitives(Random& random, int count, SearchProblem& problem) {
  for (int i = 0; i < count; ++i) {
    const auto drawn = static_cast<Shape>(random.integer(0, 2));
    const Shape shape = problem.options.primitive.value_or(drawn);
    const bool anywhere = random.chance(0.03);
    const bool buried = random.chance(0.15);
    const double place = random.uniform(0, 1);
    Capsule primitive{};
    for (int attempt = 0; attempt < 40; ++attempt) {
      Vector3d centre = random.in_cube(place < 0.75 ? 0.7 : 1.4);
      if (place > 0.95) {
        const int k = random.integer(0, static_cast<int>(problem.rig.cameras.size()) - 1);
        centre = 0.3 * centre + problem.scene.rig.cameras[static_cast<std::size_t>(k)].T_world_camera.translation();
      }
      primitive = draw_primitive(random, shape, centre);
      const Primitive asked = to_reference(primitive);
      if (anywhere || (problem.oracle->in_space(asked) && (buried || !problem.oracle->is_obstacle(asked.a_world)))) {
        break;
      }
    }
    problem.primitives.push_back(primitive);
  }
}

Policy of(views::Policy policy) { return policy == views::Policy::obstacle ? Policy::obstacle : Policy::ignored; }

/// The same question for the oracle.
Problem oracle_problem(const SearchProblem& asked) {
  Problem problem;
  double t_ref_s = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < asked.frames.size(); ++k) {
    t_ref_s = asked.present(k) ? std::max(t_ref_s, asked.frames[k].time_s) : t_ref_s;
  }
  for (std::size_t k = 0; k < asked.rig.cameras.size(); ++k) {
    const RigCamera& camera = asked.scene.rig.cameras[k];
    const CameraMargins& margins = asked.settings.margins[k];
    CameraInput input;
    input.camera = camera.intrinsics;
    input.T_world_camera = asked.present(k) ? camera.T_world_camera : asked.rig.cameras[k].T_world_camera;
    input.rule = camera.rule;
    input.frame = asked.frames[k];
    input.sensor = margins.sensor;
    input.smallest_obstacle_m = margins.smallest_obstacle_m;
    input.pose = {margins.translation_m, margins.rotation_rad, 0.0};
    if (asked.present(k)) {
      input.pose.time_m =
          asked.settings.v_max_m_s *
          (std::abs(asked.frames[k].time_s - t_ref_s) + margins.half_exposure_s + margins.time_uncertainty_s) *
          (1 + margins.rotation_rad);
    }
    input.robot_pocket_m = asked.settings.policies.ignored_pocket_m;
    problem.cameras.push_back(input);
  }
  if (const auto* frustum = std::get_if<views::FrustumSpace>(&asked.settings.space)) {
    problem.space = FrustumSpace{frustum->principal, frustum->d_min_m, frustum->d_max_m};
  } else {
    const auto& box = std::get<views::BoxSpace>(asked.settings.space);
    problem.space = WorldBox{box.low_world, box.high_world};
  }
  problem.outside = of(asked.settings.policies.outside);
  problem.uncovered = of(asked.settings.policies.unobserved);
  problem.rho_m = asked.settings.rho_m;
  return problem;
}

/// Discs and lone pixels without reading.
void punch_holes(Random& random, RandomProblem& scene) {
  for (std::size_t k = 0; k < scene.views.size(); ++k) {
    DepthImage& depth_m = scene.views[k].depth_m;
    const double lone = std::pow(10.0, random.uniform(-3, -0.5));
    const int discs = random.integer(0, 6);
    std::vector<Vector3d> holes;
    for (int i = 0; i < discs; ++i) {
      const double x = random.uniform(0, depth_m.width_px());
      const double y = random.uniform(0, depth_m.height_px());
      holes.emplace_back(x, y, random.uniform(0.5, 6));
    }
    for (int v = 0; v < depth_m.height_px(); ++v) {
      for (int u = 0; u < depth_m.width_px(); ++u) {
        const bool in_disc = std::any_of(holes.begin(), holes.end(), [&](const Vector3d& hole) {
          return std::hypot(u - hole.x(), v - hole.y()) <= hole.z();
        });
        if (random.chance(lone) || in_disc) {
          depth_m.at(u, v) = 0;
          if (!scene.units[k].empty()) {
            scene.units[k][depth_m.index(u, v)] = 0;
          }
        }
      }
    }
  }
}

/// Some problems in ten assume a smallest obstacle. Draws of its own: problems without it are what they were.
double draw_smallest_obstacle(const RandomOptions& options, RandomProblem& scene) {
  Random random(options.seed * 0x9E3779B97F4A7C15U + 4);
  const double drawn_m = random.chance(0.3) ? random.uniform(0.01, 0.15) : 0.0;
  const double smallest_m = options.smallest_m.value_or(drawn_m);
  if (smallest_m > 0) {
    punch_holes(random, scene);
  }
  return smallest_m;
}

}  // namespace

std::string SearchProblem::line(std::size_t query) const {
  RandomOptions one = options;
  one.query = static_cast<int>(query);
  return to_line(one);
}

SearchProblem make_search_problem(const RandomOptions& options, int queries) {
  Random random(options.seed * 0x9E3779B97F4A7C15U + 3);
  // Every choice is drawn, whether it is used or not, so that setting one option leaves the others as they were.
  const auto choose = [&random](const std::optional<bool>& set, double probability) {
    const bool drawn = random.chance(probability);
    return set.value_or(drawn);
  };
  RandomOptions scene = options;
  const int drawn_cameras = draw_cameras(random);
  scene.cameras = options.cameras.value_or(drawn_cameras);
  const bool margins = choose(options.margins, 0.6);
  const bool lateral = choose(options.lateral, 0.6) && (margins || options.lateral.has_value());
  scene.robot = choose(options.robot, 0.45);
  scene.hand = choose(options.hand, 0.5);
  const bool box = choose(options.box, 0.5);
  const bool unobserved = choose(options.unobserved, 0.7);
  const bool pockets = choose(options.pockets, 0.3);
  const bool skew = choose(options.skew, 0.6) && (margins || options.skew.has_value());
  const bool moved = choose(options.moved, 0.4);
  const bool missing = choose(options.missing, 0.06);
  const double drawn_resolution_m = random.chance(0.6) ? 0.005 : random.uniform(0.001, 0.02);
  const double v_max_m_s = std::array{0.25, 1.6, 2.0}[static_cast<std::size_t>(random.integer(0, 2))];

  SearchProblem problem;
  problem.options = options;
  problem.scene = make_random_problem(scene);
  Random within(options.seed * 0x9E3779B97F4A7C15U + 5);  // leaves the other draws as they were
  const bool drawn_within = within.chance(0.4);
  problem.scene.within_margin = options.within.value_or(drawn_within);
  problem.scene.refer_frames();
  problem.rig = problem.scene.rig;
  problem.ideal = !margins && !lateral && !skew;
  problem.moved = moved;
  views::Settings& settings = problem.settings;
  settings.rho_m = problem.scene.rho_m;
  settings.resolution_m = options.resolution_m.value_or(drawn_resolution_m);
  settings.v_max_m_s = skew ? v_max_m_s : 0.0;
  settings.policies.outside = problem.scene.outside_is_obstacle ? views::Policy::obstacle : views::Policy::ignored;
  settings.policies.unobserved = unobserved ? views::Policy::obstacle : views::Policy::ignored;
  settings.policies.robot_pockets = pockets ? views::Policy::ignored : views::Policy::obstacle;
  const double pocket_m = random.uniform(0, 0.06);
  settings.policies.ignored_pocket_m = pockets ? pocket_m : 0.0;
  const views::BoxSpace drawn_box = draw_box(random);
  if (box) {
    settings.space = drawn_box;
  } else {
    settings.space = views::FrustumSpace{problem.scene.principal, problem.scene.d_min_m,
                                         problem.scene.d_min_m + problem.scene.step_m * problem.scene.cell_count};
  }
  const double smallest_m = draw_smallest_obstacle(options, problem.scene);
  const int absent = random.integer(0, static_cast<int>(problem.rig.cameras.size()) - 1);
  for (std::size_t k = 0; k < problem.rig.cameras.size(); ++k) {
    CameraMargins drawn = draw_margins(random, lateral);
    if (!margins) {
      const int lateral_px = drawn.sensor.lateral_px;
      drawn = {};
      drawn.sensor.lateral_px = lateral_px;
    }
    drawn.smallest_obstacle_m = smallest_m;
    settings.margins.push_back(drawn);
    Frame frame = problem.scene.frames[k];
    const double late_s = random.uniform(0, 0.033);
    frame.time_s = 1000.0 - (skew ? late_s : 0.0);
    if (missing && static_cast<int>(k) == absent) {
      frame = {};
    }
    problem.frames.push_back(frame);
    const Vector3d shift = random.in_cube(0.2);
    const Eigen::AngleAxisd turn(random.uniform(-1, 1), random.direction());
    if (moved) {
      problem.rig.cameras[k].T_world_camera.pretranslate(shift).rotate(turn);
    }
  }
  problem.problem = oracle_problem(problem);
  problem.oracle = std::make_unique<Reference>(problem.problem);
  draw_primitives(random, queries, problem);
  return problem;
}

}  // namespace depthgrid::reference
