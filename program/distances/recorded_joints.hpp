// The joint positions of a recording, from a file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/robot/robot_model.hpp"
#include "program/distances/robot_options.hpp"

namespace depthgrid::program {

struct RecordedJoints {
  std::unique_ptr<robot::JointHistory> history;
  /// Row i holds this frame, and stands in the history at i seconds. Empty: the history has the images' clock.
  std::vector<int> frames;
  std::string file;    ///< --joints, for messages
  double first_s = 0;  ///< of the history
  double last_s = 0;
  std::string note;  ///< one line about what was read and how, for people

  /// The history's time for a frame that was taken at time_s; nothing where the file has no row of this frame.
  [[nodiscard]] std::optional<double> time_of(int frame_number, double time_s) const;
};

/// Reads --joints. The file's angles are what their columns say, else --joint-unit, else radians: then positions beyond
/// a joint's limits are refused, with a hint where they were good degrees. Slides are metres, always within their
/// limits. Throws Error that names the file, the joint and the value.
[[nodiscard]] RecordedJoints recorded_joints(const RecordedRobotOptions& options, const robot::RobotModel& model);

}  // namespace depthgrid::program
