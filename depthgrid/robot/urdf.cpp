#include "depthgrid/robot/urdf.hpp"

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/mesh_path.hpp"
#include "depthgrid/robot/urdfdom_messages.hpp"

namespace depthgrid::robot {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Vector3d vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose pose_of(const urdf::Pose& origin, const std::string& context) {
  const urdf::Rotation& r = origin.rotation;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  pose.translation() = vector_of(origin.position);
  if (!pose.matrix().allFinite()) {
    fail(context, "origin is at (", pose.translation().transpose(), ") with a rotation that is no number");
  }
  return pose;
}

double positive(double value, const char* what, const std::string& context) {
  if (!(std::isfinite(value) && value > 0)) {
    fail(context, what, " is ", value, ", must be a positive finite number");
  }
  return value;
}

/// Reads one file's robot; `source` begins its messages.
class Reader {
 public:
  Reader(std::filesystem::path file, const UrdfOptions& options) : file_(std::move(file)), options_(options) {}

  [[nodiscard]] LinkDescription link(const urdf::Link& link) const {
    LinkDescription result;
    result.name = link.name;
    const std::string context = file_.string() + ": link '" + link.name + "': ";
    for (const auto& collision : link.collision_array) {
      add_shape(collision->geometry.get(), collision->origin, context, result.shapes);
    }
    if (link.collision_array.empty()) {
      for (const auto& visual : link.visual_array) {
        add_shape(visual->geometry.get(), visual->origin, context, result.shapes);
      }
    }
    return result;
  }

  [[nodiscard]] JointDescription joint(const urdf::Joint& joint) const {
    const std::string context = file_.string() + ": joint '" + joint.name + "': ";
    JointDescription result;
    result.name = joint.name;
    result.type = type_of(joint, context);
    result.parent_link = joint.parent_link_name;
    result.child_link = joint.child_link_name;
    result.T_parent_joint = pose_of(joint.parent_to_joint_origin_transform, context);
    result.axis = vector_of(joint.axis);
    result.lower = -kInfinity;
    result.upper = kInfinity;
    result.max_speed = kInfinity;
    if (joint.limits) {
      result.max_speed = joint.limits->velocity;
      if (result.type != JointType::continuous) {
        result.lower = joint.limits->lower;
        result.upper = joint.limits->upper;
      }
    }
    if (joint.mimic) {
      result.mimic = Mimic{joint.mimic->joint_name, joint.mimic->multiplier, joint.mimic->offset};
    }
    return result;
  }

 private:
  static JointType type_of(const urdf::Joint& joint, const std::string& context) {
    switch (joint.type) {
      case urdf::Joint::FIXED:
        return JointType::fixed;
      case urdf::Joint::REVOLUTE:
        return JointType::revolute;
      case urdf::Joint::CONTINUOUS:
        return JointType::continuous;
      case urdf::Joint::PRISMATIC:
        return JointType::prismatic;
      default:
        fail(context, "its type is ", joint.type == urdf::Joint::FLOATING ? "floating" : "planar",
             ", must be fixed, revolute, continuous or prismatic");
    }
  }

  void add_shape(const urdf::Geometry* geometry, const urdf::Pose& origin, const std::string& context,
                 std::vector<LinkShape>& shapes) const {
    if (geometry == nullptr) {
      fail(context, "a shape has no geometry");
    }
    LinkShape result;
    result.T_link_shape = pose_of(origin, context);
    if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(geometry)) {
      result.shape = SphereShape{positive(sphere->radius, "radius of a sphere", context)};
    } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(geometry)) {
      result.shape = CylinderShape{positive(cylinder->radius, "radius of a cylinder", context),
                                   positive(cylinder->length, "length of a cylinder", context)};
    } else if (const auto* box = dynamic_cast<const urdf::Box*>(geometry)) {
      const Eigen::Vector3d size = vector_of(box->dim);
      positive(size.minCoeff(), "size of a box", context);
      positive(size.sum(), "size of a box", context);
      result.shape = BoxShape{size};
    } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(geometry)) {
      result.shape = MeshShape{mesh_path(mesh->filename, file_, options_, context), vector_of(mesh->scale)};
    }
    shapes.push_back(std::move(result));
  }

  std::filesystem::path file_;
  const UrdfOptions& options_;
};

}  // namespace

RobotDescription parse_urdf(const std::string& text, const std::filesystem::path& source, const UrdfOptions& options) {
  const std::string context = source.string() + ": ";
  urdf::ModelInterfaceSharedPtr model;
  std::string errors;
  {
    const UrdfdomMessages messages;
    try {
      model = urdf::parseURDF(text);
    } catch (const std::exception& error) {
      model.reset();
      errors = error.what();
    }
    errors = messages.errors() + (messages.errors().empty() || errors.empty() ? "" : "; ") + errors;
  }
  // It leaves out a shape that it cannot read, says so, and goes on: the robot would be smaller than it is.
  if (!model || !errors.empty()) {
    fail(context, "no robot can be read: ", errors.empty() ? "it is no URDF" : errors);
  }
  RobotDescription result;
  result.name = model->getName();
  result.source = source.string();
  const Reader reader(source, options);
  for (const auto& [name, link] : model->links_) {
    result.links.push_back(reader.link(*link));
  }
  for (const auto& [name, joint] : model->joints_) {
    result.joints.push_back(reader.joint(*joint));
  }
  return result;
}

RobotDescription load_urdf(const std::filesystem::path& file, const UrdfOptions& options) {
  std::error_code unused;
  std::ifstream stream(file);
  if (!std::filesystem::is_regular_file(file, unused) || !stream) {
    fail(file.string(), ": there is no such file, or it cannot be opened");
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_urdf(text.str(), file, options);
}

}  // namespace depthgrid::robot
