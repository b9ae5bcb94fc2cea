#include "depthgrid/robot/urdf_elements.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

/// Whether one letter changed, left out or added makes the two the same.
bool one_letter_apart(std::string_view a, std::string_view b) noexcept {
  if (a.size() > b.size()) {
    std::swap(a, b);
  }
  if (b.size() - a.size() > 1) {
    return false;
  }
  const std::size_t same =
      static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
  return a.substr(std::min(a.size(), same + (a.size() == b.size() ? 1 : 0))) == b.substr(std::min(b.size(), same + 1));
}

void refuse_misspelt_name(std::string_view name, std::initializer_list<std::string_view> names, const char* what,
                          const std::string& context) {
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    return;
  }
  const std::string lower = lower_case(name);
  for (const std::string_view known : names) {
    if (lower == known || (known.size() > 3 && one_letter_apart(lower, known))) {
      fail(context, what, " '", shown(name), "' is not known; is it '", known, "'?");
    }
  }
}

/// The numbers of an attribute; fewer or more than `Vector` has are an error.
template <class Vector>
std::optional<Vector> numbers_of(const pugi::xml_node& element, const char* name, const std::string& context) {
  const pugi::xml_attribute attribute = element.attribute(name);
  if (!attribute) {
    return std::nullopt;
  }
  Vector result;
  std::string_view rest = attribute.value();
  bool good = true;
  for (double& number : result) {
    const std::optional<double> value = finite_number(next_word(rest));
    good = good && value;
    number = value.value_or(0);
  }
  if (!good || !next_word(rest).empty()) {
    const std::string_view text = attribute.value();
    fail(context, "<", element.name(), " ", name, "='", shown(text), "'> must be ", result.size(), " finite number",
         result.size() > 1 ? "s" : "",
         text.find("${") == std::string_view::npos ? "" : "; is this a xacro file? `xacro FILE > arm.urdf`");
  }
  return result;
}

}  // namespace

void refuse_misspelt(const pugi::xml_node& element, std::initializer_list<std::string_view> names,
                     const std::string& context) {
  for (const pugi::xml_node& child : element.children()) {
    if (child.type() == pugi::node_element) {
      refuse_misspelt_name(child.name(), names, "element", context);
    }
  }
  for (const pugi::xml_attribute& attribute : element.attributes()) {
    refuse_misspelt_name(attribute.name(), names, "attribute", context);
  }
}

pugi::xml_node only_child(const pugi::xml_node& element, const char* name, const std::string& context) {
  const pugi::xml_node child = element.child(name);
  if (!child.next_sibling(name).empty()) {
    fail(context, "<", element.name(), "> has more than one <", name, ">, must have one");
  }
  return child;
}

std::string name_of(const pugi::xml_attribute& attribute, const std::string& what, const std::string& context) {
  const std::string_view name = attribute.value();
  if (name.empty()) {
    fail(context, what, " has no name");
  }
  if (!is_printable(name)) {
    fail(context, what, " '", shown(name), "' has a control character in its name, or a byte that is no UTF-8");
  }
  return std::string(name);
}

std::optional<double> number_of(const pugi::xml_node& element, const char* name, const std::string& context) {
  const auto number = numbers_of<Eigen::Matrix<double, 1, 1>>(element, name, context);
  return number ? std::optional<double>(number->x()) : std::nullopt;
}

std::optional<Eigen::Vector3d> vector_of(const pugi::xml_node& element, const char* name, const std::string& context) {
  return numbers_of<Eigen::Vector3d>(element, name, context);
}

void check_length_m(double value, const char* what, const std::string& context, double largest_m) {
  if (!(std::abs(value) <= largest_m)) {
    fail(context, what, " is ", value, " m, must be at most ", largest_m,
         " m; lengths in a URDF are metres: in millimetres? did you mean ", 1e-3 * value, "?");
  }
}

Pose origin_of(const pugi::xml_node& element, const std::string& context) {
  const pugi::xml_node origin = only_child(element, "origin", context);
  refuse_misspelt(origin, {"xyz", "rpy", "quat_xyzw"}, context);
  Pose pose = Pose::Identity();
  if (const auto xyz = vector_of(origin, "xyz", context)) {
    pose.translation() = *xyz;
    check_length_m(xyz->cwiseAbs().maxCoeff(), "xyz of an origin", context);
  }
  const auto rpy = vector_of(origin, "rpy", context);
  const auto quaternion = numbers_of<Eigen::Vector4d>(origin, "quat_xyzw", context);
  if (rpy && quaternion) {
    fail(context, "an origin has both rpy and quat_xyzw, must have one");
  }
  if (quaternion) {
    constexpr double kRounding = 0.01;
    if (!(std::abs(quaternion->norm() - 1) <= kRounding)) {
      fail(context, "quat_xyzw of an origin is (", quaternion->transpose(), "), must have length 1");
    }
    pose.linear() = Eigen::Quaterniond(*quaternion).normalized().toRotationMatrix();
  } else if (rpy) {
    constexpr double kMaxAngle = 4 * std::numbers::pi;
    if (!(rpy->cwiseAbs().maxCoeff() <= kMaxAngle)) {
      fail(context, "rpy of an origin is (", rpy->transpose(), "), must be within ", kMaxAngle,
           " rad; angles are radians: in degrees? did you mean (", (*rpy * (std::numbers::pi / 180)).transpose(), ")?");
    }
    const Eigen::Vector3d c = (0.5 * *rpy).array().cos();
    const Eigen::Vector3d s = (0.5 * *rpy).array().sin();
    pose.linear() = Eigen::Quaterniond(c.x() * c.y() * c.z() + s.x() * s.y() * s.z(),  // w
                                       s.x() * c.y() * c.z() - c.x() * s.y() * s.z(),  // x
                                       c.x() * s.y() * c.z() + s.x() * c.y() * s.z(),  // y
                                       c.x() * c.y() * s.z() - s.x() * s.y() * c.z())  // z
                        .normalized()
                        .toRotationMatrix();
  }
  return pose;
}

}  // namespace depthgrid::robot
