// The options of the command line that say which robot, and where its joints are.
#pragma once

#include <CLI/App.hpp>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/robot/robot_model.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "program/output_check.hpp"

namespace depthgrid::program {

struct RobotFileOptions {
  std::string file;                   ///< URDF
  std::vector<std::string> packages;  ///< NAME=FOLDER
  std::string shapes = "collision";   ///< or visual
};

/// --package and --shapes; the file's own option is the caller's.
void add_robot_file_options(CLI::App& command, RobotFileOptions& options, const char* group);

/// For load_urdf(). Throws UsageError where --package is not NAME=FOLDER, and Error where the folder is not there.
[[nodiscard]] robot::UrdfOptions urdf_options(const RobotFileOptions& options);

/// The URDF and the meshes of its shapes, of both kinds. Throws as load_urdf() and urdf_options() do.
[[nodiscard]] std::vector<NamedFile> robot_inputs(const RobotFileOptions& options);

/// "NAME=VALUE" as a joint and its position. Throws UsageError that begins with `option`.
struct NamedPosition {
  std::string joint;
  double position = 0;
};
[[nodiscard]] NamedPosition named_position(const std::string& text, const char* option);

/// Throws UsageError, beginning with `option`, where a stated position is beyond the joint's limits, or beyond a turn
/// of a joint without: mostly a unit that was mistaken.
void check_limits(const robot::Joint& joint, double position, const std::string& option);

/// Positions q for `model`: one number a joint in the model's order, or NAME=VALUE for some. The others stand at 0, or
/// at their nearest limit where 0 is beyond it. Throws UsageError that names the joint, the value and its limits.
[[nodiscard]] std::vector<double> joint_positions(const std::vector<std::string>& texts,
                                                  const robot::RobotModel& model);

/// Throws UsageError that lists the joints there are.
[[nodiscard]] std::size_t joint_index(const robot::RobotModel& model, const std::string& name, const char* option);

/// "rad" or "m".
[[nodiscard]] const char* unit_of(robot::JointType type) noexcept;

}  // namespace depthgrid::program
