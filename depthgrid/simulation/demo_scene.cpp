#include "depthgrid/simulation/demo_scene.hpp"

#include <numbers>

namespace depthgrid::simulation {

namespace {

constexpr double kRadian = std::numbers::pi / 180;
constexpr double kPedestalTop = 0.60;
constexpr double kBaseY = -0.40;

Box box_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Box box;
  box.T_world_box.translation() = centre;
  box.half_size_m = 0.5 * size;
  return box;
}

RigCamera camera(const char* id, const Eigen::Vector3d& position_world, const Eigen::Vector3d& target_world) {
  RigCamera result;
  result.id = id;
  result.intrinsics = from_opencv(640, 480, 525, 525, 319.5, 239.5);
  result.T_world_camera = look_at(position_world, target_world);
  return result;
}

/// Floor and walls: without them most rays would end nowhere, and a ray without a measurement frees nothing.
void add_room(Scene& scene) {
  scene.add(Plane{Eigen::Vector3d::UnitZ(), 0.0});
  for (const double side : {-1.0, 1.0}) {
    scene.add(Plane{side * Eigen::Vector3d::UnitX(), -3.0});
    scene.add(Plane{side * Eigen::Vector3d::UnitY(), -2.5});
  }
}

void add_furniture(Scene& scene) {
  scene.add(box_at({0, kBaseY, 0.5 * kPedestalTop}, {0.30, 0.30, kPedestalTop}));
  scene.add(box_at({0, 0.30, 0.68}, {0.50, 0.60, 0.04}));  // table
  for (const double x : {-0.20, 0.20}) {
    for (const double y : {0.05, 0.55}) {
      scene.add(box_at({x, y, 0.33}, {0.05, 0.05, 0.66}));
    }
  }
  scene.add(box_at({0, 0.32, 0.80}, {0.20, 0.20, 0.20}));  // what the arm reaches for
}

}  // namespace

DemoScene demo_scene() {
  DemoScene demo;
  add_room(demo.scene);
  add_furniture(demo.scene);

  PersonPose pose;
  pose.feet_world = {-1.15, 0.46, 0};
  pose.heading_rad = -35 * kRadian;
  pose.left_fingertips_world = {-0.95, 0.62, 1.00};
  pose.right_fingertips_world = {-0.98, 0.30, 0.90};
  for (const Capsule& part : person(pose)) {
    demo.scene.add(part);
  }

  Pose T_world_base = Pose::Identity();
  T_world_base.translation() = Eigen::Vector3d(0, kBaseY, kPedestalTop);
  demo.arm = arm(T_world_base, {90 * kRadian, -35 * kRadian, 0, 60 * kRadian, 0, -40 * kRadian, 0});
  for (const Capsule& link : demo.arm.links) {
    demo.scene.add(link, Body::robot);
  }

  demo.rig.name = "demo";
  demo.rig.cameras = {camera("camera 1", {-2.4, 0.10, 1.55}, {0, 0.10, 1.05}),
                      camera("camera 2", {1.6, 0.10, 1.55}, {0, 0.10, 1.05})};

  constexpr double kFirst = 0.42;
  constexpr int kPoints = 9;
  for (int i = 0; i < kPoints; ++i) {
    demo.control_points_world.push_back(point_on_axis(demo.arm, kFirst + (kArmLength - kFirst) * i / (kPoints - 1)));
  }
  return demo;
}

}  // namespace depthgrid::simulation
