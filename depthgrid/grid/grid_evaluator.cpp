#include "depthgrid/grid/grid_evaluator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/usable_frame.hpp"
#include "depthgrid/grid/classification.hpp"
#include "depthgrid/grid/corrected_scan.hpp"
#include "depthgrid/grid/letter_scan.hpp"
#include "depthgrid/grid/pixel_order.hpp"
#include "depthgrid/grid/possible_cells.hpp"
#include "depthgrid/grid/remembered_images.hpp"
#include "depthgrid/grid/removed_robot.hpp"

namespace depthgrid::grid {

namespace {

Rig checked(const Rig& rig, std::size_t principal) {
  if (principal >= rig.cameras.size()) {
    fail("grid evaluator: principal camera is ", principal, ", the rig has ", rig.cameras.size(), " cameras");
  }
  if (rig.cameras.size() > kMaxSecondaries + 1) {
    fail("grid evaluator: the rig has ", rig.cameras.size(), " cameras, at most ", kMaxSecondaries + 1,
         " are supported");
  }
  return checked_rig(rig, "grid evaluator");
}

}  // namespace

struct GridEvaluator::State {
  /// `rig` is checked already.
  State(const Rig& rig, std::size_t principal_index, const DepthQuantisation& quantisation,
        EvaluationSettings settings_in, std::shared_ptr<const DepthGridMap> map_in)
      : settings(std::move(settings_in)),
        principal(principal_index),
        grid(rig.cameras[principal_index].intrinsics, quantisation),
        principal_pose(rig.cameras[principal_index].T_world_camera),
        T_principal_world(principal_pose.inverse()),
        map(std::move(map_in)) {
    grid::validate(settings);
    if (settings.memory) {
      remembered = std::make_unique<RememberedImages>(rig, *settings.memory, settings.rho_m);
    }
    const bool corrected = settings.variant == Variant::corrected;
    const Pose& T_world_principal = rig.cameras[principal].T_world_camera;
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      const RigCamera& camera = rig.cameras[k];
      observations.emplace_back(camera, corrected ? &settings.sensor : nullptr);
      const Pose T_camera_principal = camera.T_world_camera.inverse() * T_world_principal;
      if (k != principal) {
        secondary_index.push_back(k);
      }
      carvers.emplace_back(camera.intrinsics, T_camera_principal, camera.rule.near_m, settings.pose);
      views.push_back({camera.intrinsics, camera.T_world_camera.inverse(), camera.rule.near_m, nullptr, nullptr});
    }
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      views[k].measured_m = &observations[k].measured_m();
      views[k].is_robot = observations[k].is_robot().data();
      if (k != principal || has_pose_margin()) {
        carving.push_back({&carvers[k], &observations[k].free_m()});
      }
    }
    if (settings.robot_pixels == RobotPixels::removed) {
      double beyond_m = grid.d_max_m() + 2 * settings.rho_m;
      for (const RigCamera& camera : rig.cameras) {
        beyond_m = std::isfinite(camera.rule.far_m) ? std::min(beyond_m, camera.rule.far_m) : beyond_m;
      }
      for (const RigCamera& camera : rig.cameras) {
        without_robot.emplace_back(camera, beyond_m);
      }
    }
    for (const std::size_t k : secondary_index) {
      secondary_depths_m.push_back(observations[k].removed_m().data());
    }
    principal_near_m = rig.cameras[principal].rule.near_m;
    const std::vector<SecondaryCamera> secondaries = secondary_cameras(rig, principal);
    if (map) {
      check_matches(*map, grid, secondaries);
    } else {
      map = std::make_shared<const DepthGridMap>(ClosedFormMap(grid, secondaries));
    }
  }

  [[nodiscard]] bool has_pose_margin() const noexcept {
    return settings.pose.translation_m > 0 || settings.pose.rotation_rad > 0 || settings.pose.time_m > 0;
  }

  /// With a reason: as "no measurement anywhere".
  FrameUpdate update(std::size_t camera, const Frame& frame, const char* reason) noexcept;
  [[nodiscard]] ControlPoint into_depth_space(const Eigen::Vector3d& p_world) const noexcept;
  [[nodiscard]] double signed_border_distance_m(const ControlPoint& point, Eigen::Vector3d& border) const noexcept;
  [[nodiscard]] PixelWindow surveillance_window(const ControlPoint& point) const noexcept;
  void scan(const ControlPoint& point, const PixelWindow& window, const PossibleCells* possible, ObstacleSet& obstacles,
            EvaluationCount& count) const noexcept;
  [[nodiscard]] Answer answer(const ObstacleSet& obstacles) const noexcept;
  void limit_to_grid(const ControlPoint& point, double border_m, const Eigen::Vector3d& border_camera,
                     Answer& result) const noexcept;

  EvaluationSettings settings;
  std::size_t principal;
  DepthGrid grid;
  Pose principal_pose;  ///< T_world_principal, as the rig says
  Pose T_principal_world;
  std::vector<RigCamera> cameras;  ///< as the rig was given
  std::shared_ptr<const DepthGridMap> map;
  double principal_near_m = 0;
  std::vector<Observation> observations;    ///< in the rig's order
  std::vector<RemovedRobot> without_robot;  ///< empty unless robot pixels are removed
  std::vector<std::size_t> secondary_index;
  std::vector<const float*> secondary_depths_m;
  std::vector<CellCarver> carvers;
  std::vector<CarvingCamera> carving;
  std::vector<ViewingCamera> views;
  std::vector<double> layers_m;  ///< around the robot, in which each camera sees nothing
  double blind_m = 0;
  bool stale = false;
  std::unique_ptr<RememberedImages> remembered;  ///< null without memory
  double reference_time_s = Proximity::kNaN;     ///< the newest exposure
};

GridEvaluator::GridEvaluator(const Rig& rig, std::size_t principal, const DepthQuantisation& quantisation,
                             const EvaluationSettings& settings, std::shared_ptr<const DepthGridMap> map)
    : state_(std::make_unique<State>(checked(rig, principal), principal, quantisation, settings, std::move(map))) {
  state_->cameras = rig.cameras;
  state_->layers_m.assign(rig.cameras.size(), 0.0);
}
GridEvaluator::~GridEvaluator() = default;
GridEvaluator::GridEvaluator(GridEvaluator&&) noexcept = default;
GridEvaluator& GridEvaluator::operator=(GridEvaluator&&) noexcept = default;

const DepthGrid& GridEvaluator::grid() const noexcept { return state_->grid; }
const EvaluationSettings& GridEvaluator::settings() const noexcept { return state_->settings; }

std::size_t GridEvaluator::camera_count() const noexcept { return state_->observations.size(); }

FrameUpdate GridEvaluator::update(std::size_t camera, const Frame& frame) noexcept {
  if (camera >= camera_count()) {
    return {UpdateResult::unusable, "the rig has no such camera"};
  }
  return state_->update(camera, frame, why_unusable(frame, state_->cameras[camera]));
}

FrameUpdate GridEvaluator::update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept {
  if (camera >= camera_count() || T_world_camera.matrix() == state_->cameras[camera].T_world_camera.matrix()) {
    return update(camera, frame);
  }
  return state_->update(camera, frame, "the grid's cameras do not move, and the pose is not the rig's");
}

FrameUpdate GridEvaluator::State::update(std::size_t camera, const Frame& frame, const char* reason) noexcept {
  const bool usable = reason == nullptr;
  const bool removes = usable && !without_robot.empty();
  const bool with_margins = settings.variant == Variant::corrected;
  layers_m[camera] = usable ? blind_layer_m(frame.robot, cameras[camera].intrinsics,
                                            with_margins ? settings.sensor : SensorMargin{0, 0, 0, 0},
                                            with_margins ? settings.pose : PoseMargin{})
                            : 0.0;
  blind_m = 0;
  for (const double layer_m : layers_m) {
    blind_m = thicker(blind_m, layer_m);
  }
  (void)observations[camera].update(removes ? without_robot[camera].of(frame) : usable ? frame : Frame{});
  double newest_s = -std::numeric_limits<double>::infinity();
  for (const Observation& o : observations) {
    if (o.present() && std::isfinite(o.time_s())) {
      newest_s = std::max(newest_s, o.time_s());
    }
  }
  reference_time_s = newest_s;
  if (remembered != nullptr) {
    remembered->update(camera, usable ? frame : Frame{});
  }
  stale = std::any_of(observations.begin(), observations.end(), [&](const Observation& o) {
    return o.present() && !(std::abs(newest_s - o.time_s()) <= settings.max_frame_age_s);
  });
  return usable ? FrameUpdate{} : FrameUpdate{UpdateResult::unusable, reason};
}

const char* why_refused(const Capsule& capsule) noexcept {
  if (!(capsule.a.allFinite() && capsule.b.allFinite())) {
    return "its place is not finite";
  }
  if (capsule.a != capsule.b) {
    return "it has a length, and the grid knows points only";
  }
  return capsule.radius_m != 0 ? "it has a radius, and the grid knows points only" : nullptr;
}

// The main function: section VI of the letter, one call a step.
Answer GridEvaluator::distance(const Capsule& capsule, EvaluationCount* count) const noexcept {
  const State& s = *state_;
  Answer result;
  if (why_refused(capsule) != nullptr) {
    return result;
  }
  const Eigen::Vector3d& p_world = capsule.a;
  const ControlPoint point = s.into_depth_space(p_world);  // (1), (2)
  Eigen::Vector3d border_camera = point.p_camera;
  // A point so far away that its coordinates overflow lies outside.
  const double border_m = point.p_camera.allFinite() ? s.signed_border_distance_m(point, border_camera) : -1.0;
  if (border_m > 0) {
    EvaluationCount local;
    ObstacleSet obstacles(s.settings.rho_m, s.settings.repulsion_alpha);
    const PixelWindow window = s.surveillance_window(point);  // (8), (9)
    std::optional<PossibleCells> possible;
    if (s.remembered != nullptr) {
      possible.emplace(s.remembered->store.snapshot(), s.reference_time_s, s.principal_pose);
    }
    s.scan(point, window, possible ? &*possible : nullptr, obstacles,
           count != nullptr ? *count : local);  // (i)-(iv) with (5)-(7)
    result = s.answer(obstacles);               // (10), (11)
  }
  s.limit_to_grid(point, border_m, border_camera, result);
  result.nearest.stale = s.stale;
  result.blind_m = s.blind_m;
  result.distance_now_m = lower_bound_after(result.nearest, 0, 0);
  if (result.nearest.nearest_world.allFinite()) {
    result.on_axis_world = p_world;
  }
  return result;
}

ImpossibleSurfaces GridEvaluator::impossible() const noexcept {
  return state_->remembered != nullptr ? state_->remembered->store.snapshot().impossible() : ImpossibleSurfaces{};
}

Past GridEvaluator::past(const Proximity& nearest) const noexcept {
  const State& s = *state_;
  return s.remembered != nullptr ? s.remembered->past(nearest, s.grid, s.principal_pose) : Past{};
}

memory::MemoryStore* GridEvaluator::memory() noexcept {
  return state_->remembered != nullptr ? &state_->remembered->store : nullptr;
}

double GridEvaluator::image_time_s(std::size_t camera) const noexcept {
  return camera < camera_count() && state_->observations[camera].present() ? state_->observations[camera].time_s()
                                                                           : Proximity::kNaN;
}

void GridEvaluator::evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept {
  const bool late = std::any_of(state_->observations.begin(), state_->observations.end(), [&](const Observation& o) {
    return o.present() && now_s - o.time_s() > state_->settings.max_image_age_s;
  });
  for (std::size_t i = 0; i < answers.size(); ++i) {
    // What has no capsule must not keep an answer of the call before.
    answers[i] = i < capsules.size() ? distance(capsules[i]) : Answer{};
    if (late && i < capsules.size()) {
      answers[i].distance_now_m = Proximity::kNaN;
      answers[i].nearest.stale = true;
    }
  }
}

ControlPoint GridEvaluator::State::into_depth_space(const Eigen::Vector3d& p_world) const noexcept {
  ControlPoint point;
  point.p_camera = T_principal_world * p_world;
  point.p = project(grid.principal(), point.p_camera);
  return point;
}

/// Distance from the point to the border of the grid and the nearest point of it: positive inside, not positive
/// outside.
double GridEvaluator::State::signed_border_distance_m(const ControlPoint& point,
                                                      Eigen::Vector3d& border) const noexcept {
  const PinholeCamera& c = grid.principal();
  const Eigen::Vector3d& p = point.p_camera;
  // Outward normals of the four sides, through the camera's centre, and of the two ends.
  const std::array<Eigen::Vector3d, 4> sides{Eigen::Vector3d(-c.fx_px, 0, -c.cx_px).normalized(),
                                             Eigen::Vector3d(c.fx_px, 0, c.cx_px - c.width_px).normalized(),
                                             Eigen::Vector3d(0, -c.fy_px, -c.cy_px).normalized(),
                                             Eigen::Vector3d(0, c.fy_px, c.cy_px - c.height_px).normalized()};
  double smallest = p.z() - grid.d_min_m();
  border = {p.x(), p.y(), grid.d_min_m()};
  if (grid.d_max_m() - p.z() < smallest) {
    smallest = grid.d_max_m() - p.z();
    border.z() = grid.d_max_m();
  }
  for (const Eigen::Vector3d& n : sides) {
    const double distance = -n.dot(p);
    if (distance < smallest) {
      smallest = distance;
      border = p + distance * n;
    }
  }
  return smallest;
}

PixelWindow GridEvaluator::State::surveillance_window(const ControlPoint& point) const noexcept {
  if (settings.window == Window::whole_image) {
    return whole_image(grid.principal());
  }
  return settings.variant == Variant::letter ? printed_window(grid.principal(), point.p, settings.rho_m)
                                             : sphere_window(grid.principal(), point.p_camera, settings.rho_m);
}

void GridEvaluator::State::scan(const ControlPoint& point, const PixelWindow& window, const PossibleCells* possible,
                                ObstacleSet& obstacles, EvaluationCount& count) const noexcept {
  const auto visit = [&](auto&& pixel) {
    if (settings.collect == Collect::hybrid) {
      visit_all(window, pixel);
    } else {
      visit_rings(window, grid.principal(), point, obstacles, pixel);
    }
  };
  if (settings.variant == Variant::corrected) {
    CorrectedScan scan(grid, observations[principal].free_m(), principal_near_m, has_pose_margin(), carving, possible,
                       settings, point, obstacles, count);
    visit([&](int u, int v) { scan.pixel(u, v); });
    return;
  }
  std::visit(
      [&](const auto& storage) {
        LetterScan scan(grid, storage, observations[principal], secondary_depths_m, settings, point, obstacles, count);
        visit([&](int u, int v) { scan.pixel(u, v); });
      },
      *map);
}

Answer GridEvaluator::State::answer(const ObstacleSet& obstacles) const noexcept {
  Answer result;
  Proximity& nearest = result.nearest;
  nearest.distance_m = obstacles.nearest_m();
  nearest.state = ProximityState::beyond_rho;
  if (!obstacles.found()) {
    return result;
  }
  const Pose T_world_principal = T_principal_world.inverse();
  const Eigen::Vector3d& nearest_camera = obstacles.nearest().point_camera;
  nearest.nearest_world = T_world_principal * nearest_camera;
  nearest.direction_world = T_world_principal.linear() * obstacles.nearest().direction_camera;

  // A second sample inside the cell: the nearest point itself lies on a face, where rounding picks the pixel.
  const int n = std::clamp(grid.cell_of(nearest_camera.z()), 0, grid.count() - 1);
  const double cell_m = grid.boundary_m(n + 1) - grid.boundary_m(n);
  const Eigen::Vector3d inside_camera =
      deproject(grid.principal(), {obstacles.u() + 0.5, obstacles.v() + 0.5, nearest_camera.z()});
  const std::array<Eigen::Vector3d, 2> samples{T_world_principal * inside_camera, nearest.nearest_world};
  const SensorMargin margin = settings.variant == Variant::corrected ? settings.sensor : SensorMargin{0, 0, 0, 0};
  const Classification classified = classify(samples, views, margin, cell_m);
  nearest.state = classified.state;
  nearest.camera = classified.camera;
  nearest.unmeasured = classified.unmeasured;

  if (settings.collect == Collect::hybrid) {
    result.obstacle_points = obstacles.count();
    result.hybrid_direction_world =
        T_world_principal.linear() * (settings.variant == Variant::letter
                                          ? obstacles.mean_direction()
                                          : obstacles.led_direction(settings.direction_blend));
  }
  return result;
}

void GridEvaluator::State::limit_to_grid(const ControlPoint& point, double border_m,
                                         const Eigen::Vector3d& border_camera, Answer& result) const noexcept {
  Proximity& nearest = result.nearest;
  const bool inside = border_m > 0;
  if (settings.outside == OutsideSpace::ignored) {
    if (inside) {
      nearest.known_to_m = border_m;
    } else {
      nearest.state = ProximityState::outside;
    }
    return;
  }
  const double distance_m = std::max(border_m, 0.0);
  if (inside && !(distance_m < nearest.distance_m)) {
    return;
  }
  nearest.distance_m = distance_m;
  nearest.state = ProximityState::outside;
  nearest.camera.reset();
  nearest.unmeasured = Unmeasured::not_told;
  const Pose T_world_principal = T_principal_world.inverse();
  nearest.nearest_world = T_world_principal * (inside ? border_camera : point.p_camera);
  nearest.direction_world = Eigen::Vector3d::Zero();
  if (inside) {
    nearest.direction_world = T_world_principal.linear() * (border_camera - point.p_camera).normalized();
  }
  if (settings.collect == Collect::hybrid) {
    result.hybrid_direction_world = nearest.direction_world;  // the border is nearest, so it leads
  }
}

}  // namespace depthgrid::grid
