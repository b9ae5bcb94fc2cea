#include "lab/recordings/ball_study.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include "depthgrid/core/sensor_models.hpp"

namespace depthgrid::lab {

namespace {

constexpr double kBallRho_m = 0.5;
constexpr std::array<double, 3> kRadii_m = {0.30, 0.40, 0.60};

/// Inside the principal camera's pyramid between the ends of the grid.
bool in_grid(const grid::DepthGrid& depth_grid, const Eigen::Vector3d& p_camera) {
  if (!(p_camera.z() > depth_grid.d_min_m() && p_camera.z() < depth_grid.d_max_m())) {
    return false;
  }
  const DepthPoint p = project(depth_grid.principal(), p_camera);
  return p.x_px >= 0 && p.y_px >= 0 && p.x_px < depth_grid.principal().width_px &&
         p.y_px < depth_grid.principal().height_px;
}

/// One camera set under one setting.
struct Runner {
  Runner(const Rig& whole, CameraSet set, const grid::EvaluationSettings& settings)
      : cameras(std::move(set)),
        rig(sub_rig(whole, cameras)),
        evaluator(rig, 0, ball_cells(), settings),
        T_principal_world(rig.cameras.front().T_world_camera.inverse()) {}

  Sample ask(const Eigen::Vector3d& p_world, const Eigen::Vector3d& ball_world, double radius_m, bool ball_seen) const {
    const Eigen::Vector3d from_ball = p_world - ball_world;
    const Eigen::Vector3d nearest_on_ball = ball_world + radius_m * from_ball.normalized();
    const Proximity answer = evaluator.distance(Capsule::point(p_world)).nearest;
    Sample sample;
    sample.principal = static_cast<std::uint8_t>(cameras.front());
    sample.cameras = static_cast<std::uint8_t>(cameras.size());
    sample.inside = in_grid(evaluator.grid(), T_principal_world * p_world) &&
                    in_grid(evaluator.grid(), T_principal_world * nearest_on_ball);
    sample.ball_seen = ball_seen;
    sample.ball_distance_m = static_cast<float>(from_ball.norm() - radius_m);
    sample.distance_m = static_cast<float>(answer.distance_m);
    sample.at_ball = (answer.nearest_world - ball_world).norm() <= kBallZone_m;
    sample.state = answer.state;
    return sample;
  }

  CameraSet cameras;
  Rig rig;
  grid::GridEvaluator evaluator;
  Pose T_principal_world;
};

/// True when the camera measures the ball where its centre projects: a depth within the ball, give or take 10 cm.
bool sees_ball(const RigCamera& camera, const Frame& frame, const Eigen::Vector3d& ball_world, double radius_m) {
  const Eigen::Vector3d ball_camera = camera.T_world_camera.inverse() * ball_world;
  if (!(ball_camera.z() > 0)) {
    return false;
  }
  const DepthPoint p = project(camera.intrinsics, ball_camera);
  const int u = static_cast<int>(std::floor(p.x_px));
  const int v = static_cast<int>(std::floor(p.y_px));
  if (!camera.intrinsics.contains(u, v)) {
    return false;
  }
  const auto depth_m = measured_depth_m(frame.depth, camera.rule, u, v);
  return depth_m && std::abs(*depth_m - (ball_camera.z() - radius_m)) < 0.1;
}

}  // namespace

std::vector<Setting> ball_settings() {
  grid::EvaluationSettings base;
  base.rho_m = kBallRho_m;
  base.window = grid::Window::region_of_surveillance;
  std::vector<Setting> settings(4, {"", base, 1});
  settings[0].name = "letter";
  settings[0].evaluation.variant = grid::Variant::letter;
  settings[1].name = "corrected, no margins";
  settings[1].evaluation.variant = grid::Variant::corrected;
  settings[2] = settings[1];
  settings[2].name = "corrected, Kinect margins";
  settings[2].evaluation.sensor = sensor_model("kinect_v1").margin;
  settings[3] = settings[2];
  settings[3].name = "corrected, Kinect margins, e = 3 cm";
  settings[3].evaluation.pose.translation_m = 0.03;
  settings[3].frame_step = 4;
  return settings;
}

std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& ball_floor) {
  std::vector<Eigen::Vector3d> points;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const int axes = std::abs(x) + std::abs(y) + std::abs(z);
        if (axes == 1 || axes == 3) {
          for (const double radius_m : kRadii_m) {
            points.emplace_back(ball_floor + radius_m * Eigen::Vector3d(x, y, z).normalized());
          }
        }
      }
    }
  }
  for (const double x : {-0.30, 0.10, 0.50}) {
    for (const double y : {2.10, 2.65, 3.20}) {
      for (const double z : {0.90, 1.50}) {
        points.emplace_back(x, y, z);
      }
    }
  }
  return points;
}

grid::DepthQuantisation ball_cells() {
  grid::DepthQuantisation cells;
  cells.count = 472;  // 0.2882 + 472 * 0.01 m = 5.0082 m
  return cells;
}

Eigen::AlignedBox3d ball_workspace_floor() { return {Eigen::Vector3d(-1.0, 1.4, 0.1), Eigen::Vector3d(1.2, 3.9, 2.0)}; }

BallStudy study_ball(files::Recording& recording, const BallTrack& track, const std::vector<int>& frames,
                     const std::vector<Setting>& settings,
                     const std::function<void(std::size_t, std::size_t)>& progress) {
  const Rig& rig = recording.rig();
  const Pose T_world_floor = rig.T_floor_world.value_or(Pose::Identity()).inverse();
  BallStudy study;
  std::vector<std::vector<Runner>> runners(settings.size());
  for (std::size_t s = 0; s < settings.size(); ++s) {
    study.settings.push_back({settings[s], {}});
    for (std::size_t principal = 0; principal < rig.cameras.size(); ++principal) {
      for (const CameraSet& set : camera_sets(rig.cameras.size(), principal)) {
        runners[s].emplace_back(rig, set, settings[s].evaluation);
        study.settings[s].sets.push_back({set, {}, 0});
        if (s == 0 && set.size() > 1) {
          study.gray.emplace_back(set, GrayArea{});
        }
      }
    }
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto images = recording.read(frames[i]);
    const auto ball = track.centre_world.find(recording.frame_number(frames[i]));
    if (ball == track.centre_world.end()) {
      continue;
    }
    const auto points_floor = points_around(T_world_floor.inverse() * ball->second);
    ++study.frames;
    study.points_per_frame = points_floor.size();
    for (std::size_t s = 0; s < settings.size(); ++s) {
      if (i % settings[s].frame_step != 0) {
        continue;
      }
      for (std::size_t n = 0; n < runners[s].size(); ++n) {
        Runner& runner = runners[s][n];
        const std::size_t principal = runner.cameras.front();
        const bool seen = sees_ball(rig.cameras[principal], images[principal], ball->second, track.radius_m);
        (void)update_all(runner.evaluator, sub_frames(images, runner.cameras));
        const auto begin = std::chrono::steady_clock::now();
        for (const auto& p_floor : points_floor) {
          study.settings[s].sets[n].samples.push_back(
              runner.ask(T_world_floor * p_floor, ball->second, track.radius_m, seen));
        }
        study.settings[s].sets[n].seconds +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      }
    }
    for (auto& [set, area] : study.gray) {
      add_gray_area(rig, set, images, ball_cells(), ball_workspace_floor(), area);
    }
    if (progress) {
      progress(i + 1, frames.size());
    }
  }
  return study;
}

}  // namespace depthgrid::lab
