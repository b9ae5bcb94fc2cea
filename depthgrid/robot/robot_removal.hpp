// Where the robot is in a camera's image: the depth interval that Frame::robot takes.
#pragma once

#include <span>
#include <vector>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/robot/capsule_spans.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_rows.hpp"

namespace depthgrid::robot {

struct RemovalSettings {
  /// Added to every capsule's radius: by how much the robot may leave its capsules, plus the camera's margin at the
  /// robot's depth, plus the error of calibration there. What stands this near to the robot is not seen
  /// (docs/robot.md).
  double padding_m = 0;
  /// Adds what half a pixel's diagonal measures at each capsule's far end: a reading may come from anywhere in its
  /// pixel, while the interval is that of the pixel's centre. False only for rendered images.
  bool whole_pixels = true;
  /// RobotView::within_margin: the sensor's margin belongs to the test whether a reading is the robot's, and need not
  /// be in the padding. Declared: nothing that is as thin as 2 m(D) stands right before the robot, along a camera's
  /// ray.
  bool margin_in_test = false;
};

/// One camera's view of the robot. Allocates in its constructor only. One thread at a time.
class RobotRemoval {
 public:
  /// Capsules of the robot's links. Throws Error when the camera is invalid, there is no capsule, one is not finite or
  /// has no positive radius, or the padding is negative or not finite.
  RobotRemoval(const PinholeCamera& camera, std::vector<LinkCapsule> capsules, const RemovalSettings& settings);

  /// The robot at the joint positions of an exposure. T_world_link: of RobotModel::link_poses(). motion_m: further
  /// padding, one a capsule (motion_padding()), or empty. reading: the depth image that the interval is for, or null.
  ///
  /// The interval of a pixel is one part of the padded capsules along the ray through its centre, without gaps: the one
  /// that holds the pixel's reading; where none does, or there is no reading, the one that holds the first surface of
  /// the capsules themselves; where the ray meets the padding only, the first. Without readings this is what
  /// simulation::Scene::render() gives. Its ends are those of capsules a little thicker (1e-5 m, 4e-6 of their
  /// distance), so that rounding loses nothing. A camera inside the padding sees an interval that starts at the
  /// smallest positive float. Its layer is the thickest of the capsules that are in the image: padding, motion, what is
  /// added for the pixels and for rounding, and half a pixel's diagonal more, as an obstacle may stand anywhere in a
  /// pixel that the interval of its centre takes.
  ///
  /// The view says which links are in the image, each with its padding and its motion.
  ///
  /// The view points into this object: it is good until the next call. It has no robot (near_m null, so that the robot
  /// is its own obstacle) when a size is wrong or a number is not finite. A reading of
  /// the wrong size, or whose rows overlap, is not used.
  [[nodiscard]] RobotView find(std::span<const Pose> T_world_link, const Pose& T_world_camera,
                               std::span<const double> motion_m = {}, const DepthView* reading = nullptr) noexcept;

  [[nodiscard]] const std::vector<LinkCapsule>& capsules() const noexcept { return capsules_; }

 private:
  [[nodiscard]] bool take(std::span<const Pose> T_world_link, const Pose& T_world_camera,
                          std::span<const double> motion_m) noexcept;
  void write(int v, const DepthView* reading) noexcept;

  PinholeCamera camera_;
  std::vector<LinkCapsule> capsules_;
  RemovalSettings settings_;
  double half_pixel_ = 0;  ///< half a pixel's diagonal at depth 1 is added to the padding; 0: it is not
  double blind_m_ = 0;     ///< of the last take()
  double reach_m_ = 0;
  int stride_px_ = 0;
  AlignedVector<float> near_m_;
  AlignedVector<float> far_m_;
  std::vector<PixelSpan> written_;  ///< of each row, by the call before
  AlignedVector<float> x_ray_;
  AlignedVector<float> reading_m_;
  AlignedVector<float> scratch_;
  std::vector<PixelSpan> spans_;          ///< of each capsule, one a row
  std::vector<RowRange> rows_;            ///< of each capsule
  std::vector<RowCapsule> in_camera_;     ///< of each capsule
  std::vector<Capsule> links_world_;      ///< of those in the image, with padding
  std::vector<RowCapsule> row_capsules_;  ///< those of one row
  std::vector<PixelSpan> row_spans_;
};

}  // namespace depthgrid::robot
