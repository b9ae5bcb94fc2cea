// Joint states of an MCAP file as a table.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "depthgrid/files/joint_table.hpp"

namespace depthgrid::files {

/// The sensor_msgs/JointState of a topic, empty: of the only one. Radians or metres; times are the headers' stamps,
/// ascending; of one time the first state counts. States that do not have all joints, a gripper's on the same topic,
/// are passed over. Throws Error that names the file and the topic: no such topic, another type, a joint that no state
/// has.
[[nodiscard]] JointTable load_mcap_joints(const std::filesystem::path& file, std::string_view topic,
                                          std::span<const std::string> joints);

}  // namespace depthgrid::files
