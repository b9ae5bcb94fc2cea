#include "program/robot_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <system_error>
#include <variant>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

/// A position that is a little beyond a limit comes from rounding.
constexpr double kLimitRounding = 1e-6;

void add_meshes(const std::string& file, const robot::UrdfOptions& options, std::vector<NamedFile>& inputs) {
  for (const robot::LinkDescription& link : robot::load_urdf(file, options).links) {
    for (const robot::LinkShape& item : link.shapes) {
      if (const auto* mesh = std::get_if<robot::MeshShape>(&item.shape)) {
        inputs.push_back({"the mesh", mesh->file});
      }
    }
  }
}

}  // namespace

void add_robot_file_options(CLI::App& command, RobotFileOptions& options, const char* group) {
  command
      .add_option("--package", options.packages,
                  "NAME=FOLDER: where package://NAME/... is; repeatable (default: a folder NAME around the URDF)")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_option("--shapes", options.shapes,
                  "shapes of the links that count: collision, or visual; the others where a link has none of these")
      ->check(CLI::IsMember({"collision", "visual"}))
      ->capture_default_str()
      ->group(group);
}

robot::UrdfOptions urdf_options(const RobotFileOptions& options) {
  robot::UrdfOptions result;
  for (const std::string& text : options.packages) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      fail_usage("--package ", text, ": must be NAME=FOLDER, where package://NAME/... is");
    }
    const std::filesystem::path folder = text.substr(equals + 1);
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) {
      fail("--package ", text, ": there is no folder ", folder.string());
    }
    result.packages[text.substr(0, equals)] = folder;
  }
  result.shapes = options.shapes == "visual" ? robot::ShapeKind::visual : robot::ShapeKind::collision;
  return result;
}

std::vector<NamedFile> robot_inputs(const RobotFileOptions& options) {
  std::vector<NamedFile> inputs{{"the robot's URDF file", options.file}};
  robot::UrdfOptions urdf = urdf_options(options);
  urdf.require_meshes = false;
  add_meshes(options.file, urdf, inputs);
  urdf.shapes = urdf.shapes == robot::ShapeKind::visual ? robot::ShapeKind::collision : robot::ShapeKind::visual;
  try {
    add_meshes(options.file, urdf, inputs);
  } catch (const Error&) {
    // What is wrong with shapes that do not count is no reason to refuse the robot.
  }
  return inputs;
}

void check_limits(const robot::Joint& joint, double position, const std::string& option) {
  if (joint.type == robot::JointType::continuous && std::abs(position) > 2 * std::numbers::pi) {
    fail_usage(option, ": joint '", joint.name, "' stands at ", position,
               " rad, more than a turn; angles are radians: is this one in degrees?");
  }
  if (position >= joint.lower - kLimitRounding && position <= joint.upper + kLimitRounding) {
    return;
  }
  const bool slides = joint.type == robot::JointType::prismatic;
  const double mistaken = position * (slides ? 1e-3 : std::numbers::pi / 180);
  const bool good = mistaken >= joint.lower && mistaken <= joint.upper;
  const char* const unit = unit_of(joint.type);
  fail_usage(option, ": joint '", joint.name, "' stands at ", position, " ", unit, ", its limits are ", joint.lower,
             " and ", joint.upper, " ", unit,
             !good    ? ""
             : slides ? "; lengths are metres: is this one in millimetres?"
                      : "; angles are radians: is this one in degrees?");
}

NamedPosition named_position(const std::string& text, const char* option) {
  const std::size_t equals = text.rfind('=');
  const auto value = equals == std::string::npos ? std::nullopt : parse_number<double>(text.substr(equals + 1));
  if (!value || !std::isfinite(*value) || equals == 0) {
    fail_usage(option, " ", text, ": must be NAME=VALUE, radians or metres");
  }
  return {text.substr(0, equals), *value};
}

std::size_t joint_index(const robot::RobotModel& model, const std::string& name, const char* option) {
  const auto& joints = model.joints();
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const auto& joint) { return joint.name == name; });
  if (found == joints.end()) {
    std::string names;
    for (const robot::Joint& joint : joints) {
      names += (names.empty() ? "" : ", ") + joint.name;
    }
    fail_usage(option, ": the robot has no joint '", name, "' that has a position of its own; it has ",
               names.empty() ? std::string("none") : names);
  }
  return static_cast<std::size_t>(found - joints.begin());
}

std::vector<double> joint_positions(const std::vector<std::string>& texts, const robot::RobotModel& model) {
  const auto& joints = model.joints();
  std::vector<double> q;
  q.reserve(joints.size());
  for (const robot::Joint& joint : joints) {
    q.push_back(std::clamp(0.0, joint.lower, joint.upper));
  }
  const auto plain = std::count_if(texts.begin(), texts.end(),
                                   [](const std::string& text) { return text.find('=') == std::string::npos; });
  if (plain > 0 && static_cast<std::size_t>(plain) != joints.size()) {
    fail_usage("--joints: ", plain, " number", plain == 1 ? "" : "s", " for ", joints.size(),
               " joints; give one for each, or NAME=VALUE for some");
  }
  std::size_t next = 0;
  std::vector<bool> named_before(joints.size(), false);
  for (const std::string& text : texts) {
    std::size_t index = next;
    if (text.find('=') == std::string::npos) {
      const auto value = parse_number<double>(text);
      if (!value || !std::isfinite(*value)) {
        fail_usage("--joints: '", text, "' is no number; radians or metres");
      }
      q[index] = *value;
      ++next;
    } else {
      const NamedPosition named = named_position(text, "--joints");
      index = joint_index(model, named.joint, "--joints");
      if (named_before[index]) {
        fail_usage("--joints ", text, ": joint '", named.joint, "' is given twice");
      }
      named_before[index] = true;
      q[index] = named.position;
    }
    check_limits(joints[index], q[index], "--joints " + text);
  }
  return q;
}

const char* unit_of(robot::JointType type) noexcept { return type == robot::JointType::prismatic ? "m" : "rad"; }

}  // namespace depthgrid::program
