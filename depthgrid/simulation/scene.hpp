// An analytic scene: planes, boxes, spheres and capsules that render depth images and give exact distances.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::simulation {

/// Whether a primitive is an obstacle or belongs to the robot.
enum class Body : std::uint8_t { obstacle, robot };

/// What one camera sees of a scene. Same size, metres, 0 = nothing there.
struct View {
  DepthImage depth_m;  ///< nearest surface, robot included
  /// Depth interval of the padded robot along the pixel's centre ray. Where the ray crosses it several times, the
  /// contiguous one that holds the first surface of the robot itself: otherwise the padding of one link would hide that
  /// another link behind it is robot too. The first one where the ray meets the padding only.
  DepthImage robot_near_m;
  DepthImage robot_far_m;
};

/// Nearest surface point of the obstacles.
struct SceneDistance {
  double distance_m = 0;  ///< to the surface; 0 inside an obstacle; infinite when there is none
  /// The point itself inside an obstacle; NaN when there is no obstacle.
  Eigen::Vector3d nearest_world = Eigen::Vector3d::Zero();
};

/// Const members may be called from many threads at once.
class Scene {
 public:
  /// Throws Error on a non-finite number, a non-positive size or a normal that is not of unit length.
  void add(const Plane& plane, Body body = Body::obstacle);
  void add(const Box& box, Body body = Body::obstacle);
  void add(const Sphere& sphere, Body body = Body::obstacle);
  void add(const Capsule& capsule, Body body = Body::obstacle);

  /// Ideal depth camera: z of the nearest surface along the ray through each pixel's centre, which is (u + 0.5, v +
  /// 0.5) in continuous image coordinates; rounded to the nearest float. With `robot` bodies the padded robot's
  /// interval is rendered too (each robot primitive grown by robot_padding_m): the merged intervals of all its
  /// primitives, up to the first gap. A camera inside or on the surface of a solid measures nothing: depth 0
  /// everywhere; one inside the padding of the robot only sees a robot interval that starts at the smallest positive
  /// float. robot_far_m may be infinite. Throws Error when the camera is invalid or the padding negative or not finite.
  [[nodiscard]] View render(const PinholeCamera& camera, const Pose& T_world_camera,
                            double robot_padding_m = 0.0) const;

  /// Exact distance from a point to the obstacles (the robot does not count). Metres, world frame.
  [[nodiscard]] SceneDistance distance(const Eigen::Vector3d& p_world) const noexcept;

  /// Whether the point lies in a solid of this body, surfaces included.
  [[nodiscard]] bool contains(const Eigen::Vector3d& p_world, Body body) const noexcept;

 private:
  template <class Shape>
  struct Item {
    Shape shape;
    Body body;
  };
  /// Calls visit(shape, body) for every primitive.
  template <class Visit>
  void for_each(Visit&& visit) const;

  std::vector<Item<Plane>> planes_;
  std::vector<Item<Box>> boxes_;
  std::vector<Item<Sphere>> spheres_;
  std::vector<Item<Capsule>> capsules_;
};

}  // namespace depthgrid::simulation
