// From a cell's description to what images are prepared with and what is asked: rig, settings, robot, questions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/files/recording.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/placed_robot.hpp"
#include "depthgrid/robot/robot_at_exposure.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::cell {

/// What an answer is about: a capsule of a link, or one that stands still.
struct AskedPart {
  std::string name;
  std::optional<robot::LinkCapsule> on_robot{};  ///< in the link's frame
  Capsule at_world{};                            ///< without a link
};

struct CellSetup {
  Rig rig;
  views::Settings settings;
  search::EvaluatorOptions options;
  std::optional<robot::PlacedRobot> robot{};
  robot::ExposureSettings exposure{};
  std::vector<AskedPart> parts{};   ///< the tool's link first
  std::vector<ShownValue> shown{};  ///< what is not in the file: intrinsics, margins
};

/// Reads the robot's and the rig's files and what recordings say of their cameras. Throws Error that names the place in
/// the cell file, or the file that is broken: a camera whose errors nobody states, a link that the robot lacks.
[[nodiscard]] CellSetup setup(const Cell& cell);

/// What of its recording a camera is: its id, topics, and what the cell's file says in place of the recording.
[[nodiscard]] files::RecordingOptions recording_options(const CameraEntry& entry);

/// The robot of the file alone. Throws Error.
[[nodiscard]] robot::RobotModel robot_model(const RobotEntry& entry);

/// Problems that do not keep the cell from running, one line each: a padding below a camera's margin, nobody listens.
[[nodiscard]] std::vector<std::string> implausible(const Cell& cell, const CellSetup& setup);

}  // namespace depthgrid::cell
