// A robot in a recording: taken out of the images, its links asked for their distances.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/files/control_points.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "program/distances/recorded_joints.hpp"
#include "program/distances/robot_options.hpp"
#include "program/distances/robot_pixels.hpp"

namespace depthgrid::program {

/// What a recording says of the times of its images.
struct ImageTimes {
  bool known = false;    ///< not only numbers
  bool stamped = false;  ///< each image has a time of its own
  double start_s = 0;    ///< of the first frame, on the clock of the joints: its stamp; 0 where there are none
};

class RecordedRobot {
 public:
  /// `rig`: as the evaluator knows it, with the margins that it takes. `T_world_rig`: from the rig file's world, in
  /// which --base is stated, to that one. Throws UsageError where options do not fit together, Error where a file is
  /// broken.
  RecordedRobot(const RecordedRobotOptions& options, const Rig& rig, const Pose& T_world_rig, const ImageTimes& times);

  /// The frames with the robot in them, good until the next call. Counts its pixels. `rig`: where the cameras were in
  /// this frame. A camera without an image has none. Throws Error where the joint positions of a frame are not known:
  /// its links then stand nowhere.
  std::span<const Frame> frames(int frame_number, std::span<const Frame> seen, const Rig& rig);

  /// The capsules of the links that move, where they are at the newest of the last frames' images, which is the time
  /// that answers are of; world frame, each called as its link. Throws Error where there are none.
  [[nodiscard]] std::vector<files::ControlPoint> link_capsules() const;

  /// Of the last frames, by camera; one a pixel.
  [[nodiscard]] const std::vector<std::vector<RobotPixel>>& pixels() const noexcept { return pixels_; }

  [[nodiscard]] const robot::RobotModel& model() const noexcept { return robot_.model; }
  /// Links that fewer joints move are not asked for.
  [[nodiscard]] int least_joints() const noexcept { return robot_.model.joints().size() > 1 ? 2 : 1; }
  /// The links where they are in the last frames, and by how much the padding of each of the robot's capsules grows for
  /// what they may have moved; at the newest image's time.
  [[nodiscard]] const std::vector<Pose>& T_world_link() const noexcept { return T_world_link_; }
  [[nodiscard]] std::vector<double> motion_m() const;

  /// Whether a pixel of the frames so far shows its capsules.
  [[nodiscard]] bool is_in_an_image() const noexcept;

  [[nodiscard]] const std::string& joints_note() const noexcept { return joints_.note; }
  /// One line a camera: pixels taken for the robot, and its model's that were not, and why.
  [[nodiscard]] std::vector<std::string> pixel_lines() const;
  /// One line for each camera whose sensor's margin is more than the padding where the robot is.
  [[nodiscard]] std::vector<std::string> padding_lines() const;

 private:
  void count(std::size_t camera, const Frame& frame, const RobotView& bare);

  Rig rig_;
  robot::PlacedRobot robot_;
  double start_s_;
  double newest_s_ = 0;  ///< of the last frames' images, on the joints' clock
  double padding_m_;
  double time_error_s_ = 0;
  std::vector<double> joint_speeds_;
  RecordedJoints joints_;
  std::unique_ptr<robot::FrameIntake> padded_;
  std::unique_ptr<robot::FrameIntake> bare_;  ///< the capsules alone
  std::vector<robot::LinkCapsule> parts_;
  std::vector<Pose> T_world_link_;
  std::vector<Frame> at_joint_times_;
  std::vector<Frame> frames_;
  std::vector<DepthImage> measured_m_;
  std::vector<std::vector<RobotPixel>> pixels_;
  std::vector<RobotPixelCount> counts_;
  std::vector<double> deepest_m_;  ///< of the capsules' surface that each camera faces
};

/// One answer a link: of capsules that are called the same, the one that is nearest, and before all others one that
/// has no distance. `points` and `answers` shrink to these, in their order.
void one_answer_a_link(std::vector<files::ControlPoint>& points, std::vector<Answer>& answers);

}  // namespace depthgrid::program
