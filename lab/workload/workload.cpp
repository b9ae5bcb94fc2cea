#include "lab/workload/workload.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::lab {

namespace {

using simulation::Body;
using simulation::Box;
using simulation::Scene;

constexpr double kTableTop = 0.75;
constexpr double kFirstPoint = 0.40;  ///< along the arm's axis from the base, metres

double wave(double time_s, double period_s, double phase) {
  return std::sin(2 * std::numbers::pi * (time_s / period_s + phase));
}

Box box_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, double heading_rad = 0) {
  Box box;
  box.T_world_box.translation() = centre;
  box.T_world_box.linear() = Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  box.half_size_m = 0.5 * size;
  return box;
}

void add_room(Scene& scene) {
  scene.add(simulation::Plane{Eigen::Vector3d::UnitZ(), 0.0});
  for (const double side : {-1.0, 1.0}) {
    scene.add(simulation::Plane{side * Eigen::Vector3d::UnitX(), -3.3});
    scene.add(simulation::Plane{side * Eigen::Vector3d::UnitY(), -3.3});
  }
}

void add_table(Scene& scene) {
  scene.add(box_at({0.15, 0, kTableTop - 0.02}, {1.3, 0.9, 0.04}));
  for (const double x : {-0.45, 0.75}) {
    for (const double y : {-0.4, 0.4}) {
      scene.add(box_at({x, y, 0.5 * (kTableTop - 0.04)}, {0.06, 0.06, kTableTop - 0.04}));
    }
  }
  scene.add(box_at({0.62, 0.25, kTableTop + 0.10}, {0.22, 0.16, 0.20}, 0.3));
  scene.add(box_at({0.60, -0.28, kTableTop + 0.07}, {0.18, 0.18, 0.14}, -0.5));
  scene.add(box_at({-0.24, 0.20, kTableTop + 0.15}, {0.16, 0.20, 0.30}));
  scene.add(box_at({-0.32, -0.26, kTableTop + 0.09}, {0.20, 0.14, 0.18}, 0.8));
  scene.add(box_at({1.25, 0.95, 0.25}, {0.5, 0.4, 0.5}, 0.4));  // on the floor
}

}  // namespace

Rig workload_rig(int cameras) {
  if (cameras < 1 || cameras > kWorkloadCameras) {
    fail("workload: ", cameras, " cameras, must be between 1 and ", kWorkloadCameras);
  }
  constexpr std::array<double, kWorkloadCameras> kAzimuth{50, 340, 150, 250, 15, 105, 200, 295};
  constexpr std::array<double, kWorkloadCameras> kRadius{2.30, 2.45, 2.60, 2.35, 2.65, 2.40, 2.55, 2.50};
  constexpr std::array<double, kWorkloadCameras> kHeight{2.1, 1.9, 2.3, 1.7, 2.4, 2.0, 1.8, 2.2};
  Rig rig;
  rig.name = "workload W";
  for (std::size_t k = 0; k < static_cast<std::size_t>(cameras); ++k) {
    RigCamera camera;
    camera.id = "camera" + std::to_string(k + 1);
    camera.intrinsics = from_opencv(640, 480, 525, 525, 319.5, 239.5);
    const double azimuth = kAzimuth[k] * std::numbers::pi / 180;
    camera.T_world_camera =
        look_at({kRadius[k] * std::cos(azimuth), kRadius[k] * std::sin(azimuth), kHeight[k]}, {0, 0, 0.95});
    rig.cameras.push_back(camera);
  }
  return rig;
}

simulation::Arm workload_arm(double time_s) noexcept {
  Pose T_world_base = Pose::Identity();
  T_world_base.translation().z() = kTableTop;
  return simulation::arm(T_world_base,
                         {0.25 * wave(time_s, 1.6, 0.0), -0.55 + 0.12 * wave(time_s, 1.2, 0.3), 0.0,
                          1.35 + 0.15 * wave(time_s, 1.0, 0.1), 0.0, -0.5 + 0.2 * wave(time_s, 0.9, 0.5), 0.0});
}

// On both sides of the table, each with one hand near the arm's front and one near its upper arm.
std::vector<Capsule> workload_people(double time_s) {
  simulation::PersonPose left;
  left.feet_world = {0.40 + 0.03 * wave(time_s, 1.7, 0.1), 0.80, 0};
  left.heading_rad = -1.75;
  left.lean_rad = 0.22 + 0.05 * wave(time_s, 1.3, 0.4);
  left.left_fingertips_world = {0.62, 0.20 + 0.10 * wave(time_s, 1.0, 0.2), 1.05 + 0.05 * wave(time_s, 0.7, 0.0)};
  left.right_fingertips_world = {0.22, 0.225 + 0.07 * wave(time_s, 1.1, 0.6), 1.33 + 0.04 * wave(time_s, 0.8, 0.3)};

  simulation::PersonPose right;
  right.feet_world = {0.25, -0.82 + 0.03 * wave(time_s, 1.9, 0.0), 0};
  right.heading_rad = 1.45;
  right.lean_rad = 0.25 + 0.04 * wave(time_s, 1.5, 0.7);
  right.left_fingertips_world = {0.10, -0.245 + 0.10 * wave(time_s, 1.2, 0.5), 1.18 + 0.05 * wave(time_s, 0.9, 0.1)};
  right.right_fingertips_world = {0.58, -0.235 + 0.13 * wave(time_s, 1.0, 0.8), 1.12 + 0.04 * wave(time_s, 1.2, 0.5)};

  std::vector<Capsule> limbs;
  for (const simulation::PersonPose& pose : {left, right}) {
    const auto parts = simulation::person(pose);
    limbs.insert(limbs.end(), parts.begin(), parts.end());
  }
  return limbs;
}

simulation::Scene workload_scene(double time_s, RobotInView robot) {
  Scene scene;
  add_room(scene);
  add_table(scene);
  for (const Capsule& limb : workload_people(time_s)) {
    scene.add(limb);
  }
  if (robot == RobotInView::masked) {
    for (const Capsule& link : workload_arm(time_s).links) {
      scene.add(link, Body::robot);
    }
  }
  return scene;
}

std::vector<Eigen::Vector3d> workload_points(double time_s) {
  const simulation::Arm arm = workload_arm(time_s);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < kWorkloadControlPoints; ++i) {
    const double share = static_cast<double>(i) / (kWorkloadControlPoints - 1);
    points.push_back(simulation::point_on_axis(arm, kFirstPoint + share * (simulation::kArmLength - kFirstPoint)));
  }
  return points;
}

std::vector<Eigen::Vector3d> random_workload_points(double time_s, std::size_t count, std::uint64_t seed) {
  const simulation::Arm arm = workload_arm(time_s);
  // One generator step a number, so that the points do not depend on the standard library's distributions.
  std::mt19937_64 generator(seed);
  const auto uniform = [&generator](double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(generator() >> 11U) * 0x1p-53;
  };
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p = simulation::point_on_axis(arm, uniform(kFirstPoint, simulation::kArmLength));
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] += uniform(-0.02, 0.02);
    }
    points.push_back(p);
  }
  return points;
}

Workload::Workload(int cameras, int frame_sets, const std::function<void(int, int)>& progress)
    : Workload(workload_rig(cameras), frame_sets, kWorkloadRobotPadding, progress) {}

Workload::Workload(const Rig& rig, int frame_sets, double robot_padding_m,
                   const std::function<void(int, int)>& progress, RobotInView robot)
    : rig_(rig), frame_sets_(frame_sets) {
  if (frame_sets < 1) {
    fail("workload: ", frame_sets, " frame sets, must be at least 1");
  }
  const int total = static_cast<int>(rig.cameras.size()) * frame_sets;
  images_.reserve(static_cast<std::size_t>(total));
  for (int set = 0; set < frame_sets; ++set) {
    const Scene scene = workload_scene(time_s(set), robot);
    for (const RigCamera& camera : rig_.cameras) {
      simulation::View view = scene.render(camera.intrinsics, camera.T_world_camera, robot_padding_m);
      const std::size_t pixels =
          static_cast<std::size_t>(camera.intrinsics.width_px) * static_cast<std::size_t>(camera.intrinsics.height_px);
      Images images{std::vector<std::uint16_t>(pixels), std::move(view.robot_near_m), std::move(view.robot_far_m)};
      std::transform(view.depth_m.data(), view.depth_m.data() + pixels, images.depth_mm.begin(),
                     [](float z) { return static_cast<std::uint16_t>(std::lround(z * 1000.0)); });
      images_.push_back(std::move(images));
      const Images& kept = images_.back();
      Frame frame;
      frame.depth = depth_view(std::span<const std::uint16_t>(kept.depth_mm), camera.intrinsics.width_px,
                               camera.intrinsics.height_px, camera.metres_per_unit);
      if (robot == RobotInView::masked) {
        frame.robot = with_layer({kept.robot_near_m.data(), kept.robot_far_m.data(), camera.intrinsics.width_px},
                                 camera.intrinsics, robot_padding_m);
      }
      frame.time_s = time_s(set);
      frames_.push_back(frame);
      if (progress) {
        progress(static_cast<int>(images_.size()), total);
      }
    }
  }
}

std::span<const Frame> Workload::frames(int frame_set) const noexcept {
  return std::span(frames_).subspan(static_cast<std::size_t>(frame_set) * rig_.cameras.size(), rig_.cameras.size());
}

}  // namespace depthgrid::lab
