#include "depthgrid/robot/urdf.hpp"

#include <pugixml.hpp>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/robot_file.hpp"
#include "depthgrid/robot/urdf_elements.hpp"
#include "depthgrid/robot/urdf_joints.hpp"
#include "depthgrid/robot/urdf_shapes.hpp"
#include "depthgrid/robot/words.hpp"
#include "depthgrid/robot/xml.hpp"

namespace depthgrid::robot {

namespace {

constexpr std::size_t kMaxUrdfBytes = std::size_t{1} << 25;
constexpr int kMaxElements = 10'000;  // links, joints and all others

void refuse_version(const pugi::xml_node& robot, const std::string& context) {
  const std::string_view version = robot.attribute("version").value();
  if (!version.empty() && version != "1" && !version.starts_with("1.")) {
    fail(context, "is URDF of version '", shown(version), "', must be 1.0, 1.1 or 1.2");
  }
}

LinkDescription link_of(const pugi::xml_node& link, const std::filesystem::path& source, const UrdfOptions& options) {
  LinkDescription result;
  result.name = name_of(link.attribute("name"), "a link", source.string() + ": ");
  const std::string context = source.string() + ": link '" + result.name + "': ";
  refuse_misspelt(link, {"name", "visual", "collision", "inertial"}, context);
  add_shapes(link, source, options, context, result);
  return result;
}

}  // namespace

RobotDescription parse_urdf(const std::string& text, const std::filesystem::path& source, const UrdfOptions& options) {
  const std::string context = source.string() + ": ";
  if (text.size() > kMaxUrdfBytes) {
    fail(context, "has ", text.size(), " bytes, must have at most ", kMaxUrdfBytes);
  }
  pugi::xml_document document;
  const pugi::xml_node robot = parse_xml(text, "robot", context, document);
  refuse_version(robot, context);
  refuse_misspelt(robot, {"link", "joint", "name", "version"}, context);
  RobotDescription result;
  result.name = shown(robot.attribute("name").value());
  result.source = source.string();
  int elements = 0;
  for (const pugi::xml_node& element : robot.children()) {
    if (const std::string_view kind = element.name(); kind == "link") {
      result.links.push_back(link_of(element, source, options));
    } else if (kind.starts_with("xacro:")) {
      fail(context, "holds <", shown(kind), ">: it is a xacro file, make the URDF with `xacro FILE > arm.urdf`");
    }
    if (++elements > kMaxElements) {
      fail(context, "has more than ", kMaxElements, " elements, as no robot has");
    }
  }
  add_joints(robot, result);
  return result;
}

RobotDescription load_urdf(const std::filesystem::path& file, const UrdfOptions& options) {
  return parse_urdf(read_robot_file(file, kMaxUrdfBytes), file, options);
}

}  // namespace depthgrid::robot
