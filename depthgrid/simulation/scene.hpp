// An analytic scene: planes, boxes, spheres and capsules that render depth images and give exact distances.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::simulation {

/// Half space { x : normal . x <= offset_m } is solid. World frame.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  double offset_m = 0;
};
struct Box {
  Pose T_world_box = Pose::Identity();  ///< centre and axes
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Constant(0.5);
};
struct Sphere {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  double radius_m = 0.1;
};
/// All points within radius_m of the segment a-b.
struct Capsule {
  Eigen::Vector3d a_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_world = Eigen::Vector3d::UnitZ();
  double radius_m = 0.1;
};

/// Whether a primitive is an obstacle or belongs to the robot.
enum class Body : std::uint8_t { obstacle, robot };

/// What one camera sees of a scene. Same size, metres, 0 = nothing there.
struct View {
  DepthImage depth_m;       ///< nearest surface, robot included
  DepthImage robot_near_m;  ///< first contiguous depth interval of the padded robot along the pixel's centre ray
  DepthImage robot_far_m;
};

/// Nearest surface point of the obstacles.
struct SceneDistance {
  double distance_m = 0;  ///< to the surface; 0 inside an obstacle; infinite when there is none
  Eigen::Vector3d nearest_world = Eigen::Vector3d::Zero();
};

class Scene {
 public:
  /// Throws Error on a non-finite number, a non-positive size or a normal that is not of unit length.
  void add(const Plane& plane, Body body = Body::obstacle);
  void add(const Box& box, Body body = Body::obstacle);
  void add(const Sphere& sphere, Body body = Body::obstacle);
  void add(const Capsule& capsule, Body body = Body::obstacle);

  /// Ideal depth camera: z of the nearest surface along the ray through each pixel's centre. With `robot` the padded
  /// robot's interval is rendered too (each robot primitive grown by robot_padding_m).
  [[nodiscard]] View render(const PinholeCamera& camera, const Pose& T_world_camera,
                            double robot_padding_m = 0.0) const;

  /// Exact distance from a point to the obstacles (the robot does not count). Metres, world frame.
  [[nodiscard]] SceneDistance distance(const Eigen::Vector3d& p_world) const noexcept;

 private:
  template <class Shape>
  struct Item {
    Shape shape;
    Body body;
  };
  std::vector<Item<Plane>> planes_;
  std::vector<Item<Box>> boxes_;
  std::vector<Item<Sphere>> spheres_;
  std::vector<Item<Capsule>> capsules_;
};

}  // namespace depthgrid::simulation
