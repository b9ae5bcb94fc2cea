// Workload W: a room with a robot cell, an arm on a table, two people reaching in and eight depth cameras around it.
//
// Room 6.6 x 6.6 m with floor and walls; a table with four legs and five boxes; an arm of 7 capsules on the table; two
// people of 17 capsules each. Cameras 640x480, f = 525 px, 2.3-2.65 m from the vertical axis through the origin, aimed
// at (0, 0, 0.95). Depth is z in millimetres, without noise. Everything that moves is a function of time alone: the
// same call always gives the same data. World frame: z up, z = 0 on the floor, metres.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/simulation/figures.hpp"
#include "depthgrid/simulation/scene.hpp"

namespace depthgrid::lab {

inline constexpr int kWorkloadCameras = 8;
inline constexpr int kWorkloadFrameSets = 30;
inline constexpr double kWorkloadRate = 30.0;          ///< frame sets a second
inline constexpr double kWorkloadRobotPadding = 0.02;  ///< metres around the robot in its near and far images
inline constexpr std::size_t kWorkloadControlPoints = 9;

/// The first `cameras` of the eight. Throws Error unless 1 <= cameras <= 8.
[[nodiscard]] Rig workload_rig(int cameras = kWorkloadCameras);

/// Whether the cameras see the arm (and its interval), or look through it as if it had been removed perfectly.
enum class RobotInView : std::uint8_t { masked, removed };

/// The scene at a time in seconds; the arm is Body::robot.
[[nodiscard]] simulation::Scene workload_scene(double time_s, RobotInView robot = RobotInView::masked);

/// The arm at a time in seconds.
[[nodiscard]] simulation::Arm workload_arm(double time_s) noexcept;

/// The limbs of both people at a time in seconds, world frame.
[[nodiscard]] std::vector<Capsule> workload_people(double time_s);

/// Nine control points evenly spaced on the arm's axis from above the shoulder to the tool's tip.
[[nodiscard]] std::vector<Eigen::Vector3d> workload_points(double time_s);

/// `count` points anywhere on that part of the axis, moved by up to 2 cm to any side. Repeatable by seed.
[[nodiscard]] std::vector<Eigen::Vector3d> random_workload_points(double time_s, std::size_t count, std::uint64_t seed);

/// Rendered frame sets. Owns all images: about 3 MB a frame of one camera.
class Workload {
 public:
  /// Renders `frame_sets` frame sets of the first `cameras` cameras on the calling thread (some 40 ms an image);
  /// `progress(done, total)` is called after every image. Throws Error unless 1 <= cameras <= 8 and frame_sets >= 1.
  explicit Workload(int cameras = kWorkloadCameras, int frame_sets = kWorkloadFrameSets,
                    const std::function<void(int, int)>& progress = {});
  /// The same scene with another rig (another size of images, fewer cameras) or another padding of the robot.
  Workload(const Rig& rig, int frame_sets, double robot_padding_m, const std::function<void(int, int)>& progress = {},
           RobotInView robot = RobotInView::masked);

  [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
  [[nodiscard]] int frame_sets() const noexcept { return frame_sets_; }
  [[nodiscard]] static double time_s(int frame_set) noexcept { return frame_set / kWorkloadRate; }
  /// One frame a camera in the rig's order, robot intervals included; valid as long as the workload.
  [[nodiscard]] std::span<const Frame> frames(int frame_set) const noexcept;

 private:
  struct Images {
    std::vector<std::uint16_t> depth_mm;
    DepthImage robot_near_m;
    DepthImage robot_far_m;
  };
  Rig rig_;
  int frame_sets_;
  std::vector<Images> images_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::lab
