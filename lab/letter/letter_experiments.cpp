#include "lab/letter/letter_experiments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/grid/map/parallel_for.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "reference/random_problem.hpp"
#include "report/statistics.hpp"

namespace depthgrid::lab {
namespace {

using Eigen::Vector3d;
using reference::Random;

constexpr double kRhoM = 0.4;
constexpr float kFarM = 6.0F;  // beyond the grid: nothing there
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PinholeCamera kinect() { return {640, 480, 525, 525, 320, 240}; }

/// Cameras with float images of a far background.
struct FarRig {
  Rig rig;
  std::vector<std::vector<float>> images;
  std::vector<Frame> frames;

  void add(const Pose& T_world_camera) {
    RigCamera camera;
    camera.id = "camera" + std::to_string(rig.cameras.size());
    camera.intrinsics = kinect();
    camera.T_world_camera = T_world_camera;
    rig.cameras.push_back(camera);
    images.emplace_back(640 * 480, kFarM);
  }
  void render(const simulation::Scene& scene) {
    for (std::size_t k = 0; k < images.size(); ++k) {
      const simulation::View view = scene.render(kinect(), rig.cameras[k].T_world_camera);
      for (std::size_t i = 0; i < images[k].size(); ++i) {
        const float depth_m = view.depth_m.data()[i];
        images[k][i] = depth_m > 0 ? depth_m : kFarM;
      }
    }
  }
  [[nodiscard]] grid::GridEvaluator evaluator(grid::Variant variant, grid::Window window) {
    grid::EvaluationSettings settings;
    settings.variant = variant;
    settings.window = window;
    settings.rho_m = kRhoM;
    settings.sensor.lateral_px = 0;
    grid::GridEvaluator result(rig, 0, grid::DepthQuantisation{}, settings);
    frames.clear();
    for (const std::vector<float>& image : images) {
      Frame frame;
      frame.depth = depth_view(image, 640, 480);
      frames.push_back(frame);
    }
    (void)update_all(result, frames);
    return result;
  }
};

Excess summarise(std::string name, const std::vector<double>& values_m) {
  Excess result{std::move(name), static_cast<std::int64_t>(values_m.size())};
  if (!values_m.empty()) {
    result.median_m = report::quantile(values_m, 0.5);
    result.q99_m = report::quantile(values_m, 0.99);
    result.largest_m = report::quantile(values_m, 1);
  }
  return result;
}

/// A point in view and a pixel whose ray passes within rho of it. Half of the points lie near the image's border,
/// where the errors are largest.
struct Case {
  Vector3d p_camera;
  DepthPoint p;
  int u = 0, v = 0;
  double depth_m = 0;  ///< of the point on the ray that was drawn
};

Case draw_case(Random& random) {
  const PinholeCamera camera = kinect();
  for (;;) {
    Case result;
    const double border = random.chance(0.5) ? 0.1 : 1.0;
    const double x = random.uniform(0, border);
    const double y = random.uniform(0, border);
    result.p = {camera.width_px * (random.chance(0.5) ? x : 1 - x), camera.height_px * (random.chance(0.5) ? y : 1 - y),
                random.uniform(0.4, 3.7)};
    result.p_camera = deproject(camera, result.p);
    const Vector3d q = result.p_camera + random.uniform(0, kRhoM) * random.direction();
    if (q.z() < 0.3) {
      continue;
    }
    const DepthPoint at = project(camera, q);
    result.u = static_cast<int>(std::floor(at.x_px));
    result.v = static_cast<int>(std::floor(at.y_px));
    result.depth_m = q.z();
    if (camera.contains(result.u, result.v)) {
      return result;
    }
  }
}

/// By how much (5)-(7) exceed the exact distance, for the 1 cm cell that holds the case's point on the ray, or for a
/// surface there with everything behind it. Nothing where the case does not count.
std::optional<double> clamp_excess_m(const Case& c, bool surface) {
  if (surface && c.depth_m < c.p.depth_m) {
    return std::nullopt;
  }
  const double d1_m = surface ? c.depth_m : 0.2882 + 0.01 * std::floor((c.depth_m - 0.2882) / 0.01);
  const double d2_m = surface ? kInfinity : d1_m + 0.01;
  const double exact_m = nearest_point(pixel_frustum(kinect(), c.u, c.v, d1_m, d2_m), c.p_camera).distance_m;
  if (exact_m >= kRhoM) {
    return std::nullopt;
  }
  return nearest_point_letter(kinect(), c.u, c.v, d1_m, surface ? d1_m : d2_m, c.p).distance_m - exact_m;
}

/// A case nearby; unchanged where that leaves the image or the depths.
Case moved(const Case& c, double scale, Random& random) {
  Case result = c;
  result.p.x_px = std::clamp(c.p.x_px + 100 * scale * random.uniform(-1, 1), 0.0, 639.999);
  result.p.y_px = std::clamp(c.p.y_px + 100 * scale * random.uniform(-1, 1), 0.0, 479.999);
  result.p.depth_m += 0.2 * scale * random.uniform(-1, 1);
  result.u = std::clamp(c.u + static_cast<int>(std::lround(100 * scale * random.uniform(-1, 1))), 0, 639);
  result.v = std::clamp(c.v + static_cast<int>(std::lround(100 * scale * random.uniform(-1, 1))), 0, 479);
  result.depth_m += 0.2 * scale * random.uniform(-1, 1);
  if (!(result.p.depth_m >= 0.4 && result.p.depth_m <= 3.7 && result.depth_m >= 0.3)) {
    return c;
  }
  result.p_camera = deproject(kinect(), result.p);
  return result;
}

std::string depth_class(double depth_m) { return depth_m < 1 ? "0.4 to 1 m" : depth_m < 2 ? "1 to 2 m" : "2 to 3.7 m"; }

}  // namespace

std::vector<WindowMiss> measure_window() {
  std::vector<WindowMiss> rows;
  for (const double depth_m : {1.0, 1.5, 2.0, 3.0}) {
    FarRig far;
    far.add(Pose::Identity());
    WindowMiss row;
    row.depth_m = depth_m;
    row.first_missed_m = kInfinity;
    const Vector3d p_world(0, 0, depth_m - 1e-3);
    for (int u = 320; u < 640; ++u) {
      std::vector<float>& image = far.images[0];
      std::fill(image.begin(), image.end(), kFarM);
      image[static_cast<std::size_t>(240 * 640 + u)] = static_cast<float>(depth_m);
      const double there_m = nearest_point(pixel_frustum(kinect(), u, 240, depth_m, kInfinity), p_world).distance_m;
      if (there_m >= kRhoM) {
        break;
      }
      const auto found = [&](grid::Window window) {
        return far.evaluator(grid::Variant::letter, window).distance(Capsule::point(p_world)).nearest.distance_m <
               kRhoM;
      };
      if (!found(grid::Window::region_of_surveillance)) {
        row.first_missed_m = std::min(row.first_missed_m, there_m);
      }
      if (found(grid::Window::whole_image)) {
        row.last_whole_m = there_m;
      }
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<Excess> measure_clamp(std::uint64_t seed, std::int64_t cases) {
  Random random(seed);
  std::vector<Excess> rows;
  for (const bool surface : {false, true}) {
    for (const std::string depths : {"0.4 to 1 m", "1 to 2 m", "2 to 3.7 m"}) {
      std::vector<double> excess_m;
      Case worst;
      double worst_m = 0;
      const auto look_at_case = [&](const Case& c) {
        const std::optional<double> value_m = clamp_excess_m(c, surface);
        if (!value_m || depth_class(c.p.depth_m) != depths) {
          return false;
        }
        if (*value_m > worst_m) {
          worst_m = *value_m;
          worst = c;
        }
        excess_m.push_back(*value_m);
        return true;
      };
      while (static_cast<std::int64_t>(excess_m.size()) < cases / 6) {
        look_at_case(draw_case(random));
      }
      Excess row = summarise((surface ? "surface of case (ii), point at " : "1 cm cell, point at ") + depths, excess_m);
      // Random cases rarely meet the corner where the error is largest: go on from the worst one.
      for (int step = 0; step < 20000; ++step) {
        look_at_case(moved(worst, std::pow(10.0, random.uniform(-4, 0)), random));
      }
      row.largest_m = worst_m;
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<Excess> measure_order(std::uint64_t seed, std::int64_t cases) {
  Random random(seed);
  struct Class {
    const char* name;
    double low, high;
    std::vector<double> capped_m, uncapped_m;
  };
  std::vector<Class> classes{{"within 10 degrees of the axis", 0, 10, {}, {}},
                             {"10 to 25 degrees", 10, 25, {}, {}},
                             {"beyond 25 degrees", 25, 90, {}, {}}};
  for (std::int64_t i = 0; i < cases; ++i) {
    const Case c = draw_case(random);
    const double angle = std::acos(c.p_camera.normalized().z()) * 57.29577951308232;
    const int up = random.integer(1, 40);
    const int down = random.integer(1, 40);
    const double cell_m = 0.2882 + 0.01 * std::floor((c.p.depth_m - 0.2882) / 0.01);
    const auto distance_m = [&](int j) {
      const double d1_m = cell_m + 0.01 * j;
      return d1_m < 0.1 ? kInfinity
                        : nearest_point(pixel_frustum(kinect(), c.u, c.v, d1_m, d1_m + 0.01), c.p_camera).distance_m;
    };
    const double up_m = distance_m(up);
    const double down_m = distance_m(-down);
    const double best_m = std::min(up_m, down_m);
    const double first_m = up < down ? up_m : down < up ? down_m : best_m;
    if (best_m >= kRhoM || !std::isfinite(first_m)) {
      continue;
    }
    for (Class& slot : classes) {
      if (angle >= slot.low && angle < slot.high) {
        slot.capped_m.push_back(std::min(first_m, kRhoM) - best_m);
        slot.uncapped_m.push_back(first_m - best_m);
      }
    }
  }
  std::vector<Excess> rows;
  for (Class& slot : classes) {
    rows.push_back(summarise(std::string(slot.name) + ", answer capped at rho", slot.capped_m));
    rows.push_back(summarise(std::string(slot.name) + ", uncapped", slot.uncapped_m));
  }
  return rows;
}

namespace {

struct Object {
  const char* name;
  double size_m;
  bool cube;
};

Vanishing vanishing_of(const Object& object, int secondaries, bool behind, int trials, std::uint64_t seed) {
  Random random(seed);
  Vanishing row;
  row.object = object.name;
  row.secondaries = secondaries;
  row.point_behind = behind;
  while (row.trials < trials) {
    simulation::Scene scene;
    const Vector3d centre = random.in_cube(0.2);
    if (object.cube) {
      Pose pose = Pose::Identity();
      pose.linear() = Eigen::AngleAxisd(random.uniform(-3.1, 3.1), random.direction()).toRotationMatrix();
      pose.translation() = centre;
      scene.add(simulation::Box{pose, Vector3d::Constant(0.5 * object.size_m)});
    } else {
      scene.add(simulation::Sphere{centre, 0.5 * object.size_m});
    }
    FarRig far;
    for (int k = 0; k <= secondaries; ++k) {
      const Vector3d position = random.uniform(1.5, 2.5) * random.direction();
      far.add(look_at(position, random.in_cube(0.1), random.direction()));
    }
    const Pose T_camera_world = far.rig.cameras[0].T_world_camera.inverse(Eigen::Isometry);
    const Vector3d p_world = centre + random.uniform(0.08, 0.25) * random.direction();
    const Vector3d p = T_camera_world * p_world;
    const DepthPoint at = project(kinect(), p);
    const bool deeper = p.z() > (T_camera_world * centre).z() + 0.5 * object.size_m;
    if ((behind && !deeper) || !(at.x_px > 0 && at.y_px > 0 && at.x_px < 640 && at.y_px < 480) || p.z() > 3.5) {
      continue;
    }
    far.render(scene);
    ++row.trials;
    // The object's surface is nearer than its centre; an answer 5 cm beyond the centre is about something else.
    const double limit_m = (p_world - centre).norm() + 0.05;
    const auto misses = [&](grid::Variant variant) {
      return far.evaluator(variant, grid::Window::whole_image).distance(Capsule::point(p_world)).nearest.distance_m >
             limit_m;
    };
    row.letter += misses(grid::Variant::letter) ? 1 : 0;
    row.corrected += misses(grid::Variant::corrected) ? 1 : 0;
  }
  return row;
}

}  // namespace

std::vector<Vanishing> measure_vanishing(std::uint64_t seed, int trials, int threads,
                                         const std::function<void(std::size_t, std::size_t)>& progress) {
  struct Job {
    Object object;
    int secondaries;
    bool behind;
  };
  std::vector<Job> jobs;
  for (const Object& object : {Object{"sphere of 1 cm", 0.01, false}, Object{"cube of 1 cm", 0.01, true},
                               Object{"sphere of 2 cm", 0.02, false}, Object{"sphere of 5 cm", 0.05, false}}) {
    for (const bool behind : {true, false}) {
      for (int secondaries = 1; secondaries <= 3; ++secondaries) {
        jobs.push_back({object, secondaries, behind});
      }
    }
  }
  std::vector<Vanishing> rows(jobs.size());
  const auto work = [&](std::size_t i) {
    rows[i] = vanishing_of(jobs[i].object, jobs[i].secondaries, jobs[i].behind, trials, seed + i);
  };
  (void)grid::parallel_for(jobs.size(), threads, work, [&](std::size_t done) {
    progress(done, jobs.size());
    return true;
  });
  return rows;
}

}  // namespace depthgrid::lab
