// Elements, attributes and numbers of a URDF file, none of them overlooked. Internal.
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "depthgrid/core/pose.hpp"

namespace depthgrid::robot {

/// Throws where a child or an attribute of `element` is one of `names` but for its case or one letter: a reader that
/// takes no notice of <Link> makes a robot smaller than described.
void refuse_misspelt(const pugi::xml_node& element, std::initializer_list<std::string_view> names,
                     const std::string& context);

/// The child of that name, or none; throws where there are two.
[[nodiscard]] pugi::xml_node only_child(const pugi::xml_node& element, const char* name, const std::string& context);

/// A name: not empty, and it prints. `what` is for the message: "link", say.
[[nodiscard]] std::string name_of(const pugi::xml_attribute& attribute, const std::string& what,
                                  const std::string& context);

/// An attribute as a finite number; none where it is not there.
[[nodiscard]] std::optional<double> number_of(const pugi::xml_node& element, const char* name,
                                              const std::string& context);

/// An attribute as three finite numbers; none where it is not there.
[[nodiscard]] std::optional<Eigen::Vector3d> vector_of(const pugi::xml_node& element, const char* name,
                                                       const std::string& context);

/// Longest accepted length of a robot, either way: longer ones are millimetres.
inline constexpr double kMaxLength_m = 30;

/// Throws where a length is more than that, with the value in metres that was probably meant.
void check_length_m(double value, const char* what, const std::string& context, double largest_m = kMaxLength_m);

/// The <origin> of an element: xyz with rpy or, since version 1.1, quat_xyzw. The identity where there is none.
[[nodiscard]] Pose origin_of(const pugi::xml_node& element, const std::string& context);

}  // namespace depthgrid::robot
