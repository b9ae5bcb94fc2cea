#include "depthgrid/robot/urdf_shapes.hpp"

#include <optional>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/mesh_path.hpp"
#include "depthgrid/robot/urdf_elements.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

using Shape = decltype(LinkShape::shape);

/// "radius of a sphere": a length that must be stated and not be negative.
double stated_length(const pugi::xml_node& shape, const char* name, const std::string& context) {
  const std::string what = std::string(name) + " of a " + shape.name();
  const std::optional<double> value = number_of(shape, name, context);
  if (!value || *value < 0) {
    fail(context, what, " is ", value ? shown(shape.attribute(name).value()) : "not stated", ", must not be negative");
  }
  constexpr double kMaxRadius = 5;
  check_length_m(*value, what.c_str(), context, std::string_view(name) == "radius" ? kMaxRadius : kMaxLength_m);
  return *value;
}

BoxShape box_of(const pugi::xml_node& element, const std::string& context) {
  const auto size = vector_of(element, "size", context);
  if (!size || size->minCoeff() < 0) {
    fail(context, "size of a box is '", shown(element.attribute("size").value()), "', must be three lengths >= 0");
  }
  check_length_m(size->maxCoeff(), "size of a box", context);
  return BoxShape{*size};
}

MeshShape mesh_of(const pugi::xml_node& element, const std::filesystem::path& file, const UrdfOptions& options,
                  const std::string& context) {
  const std::string name = name_of(element.attribute("filename"), "a mesh's file", context);
  const Eigen::Vector3d scale = vector_of(element, "scale", context).value_or(Eigen::Vector3d::Ones());
  if (!(scale.cwiseAbs().minCoeff() > 0)) {
    fail(context, "mesh '", shown(name), "' has scale (", scale.transpose(),
         "), must not be 0; it is 1 1 1 for a file in metres");
  }
  return MeshShape{mesh_path(name, file, options, context), scale, name};
}

/// None where the shape is a point.
std::optional<Shape> shape_of(const pugi::xml_node& element, const std::filesystem::path& file,
                              const UrdfOptions& options, const std::string& context) {
  const std::string_view kind = element.name();
  refuse_misspelt(element, {"radius", "length", "size", "filename", "scale"}, context);
  const auto unless_a_point = [](double extent_m, const auto& shape) {
    std::optional<Shape> result;
    if (extent_m > 0) {
      result.emplace(shape);
    }
    return result;
  };
  if (kind == "sphere") {
    const double radius_m = stated_length(element, "radius", context);
    return unless_a_point(radius_m, SphereShape{radius_m});
  }
  if (kind == "cylinder" || kind == "capsule") {
    const double radius_m = stated_length(element, "radius", context);
    const double length_m = stated_length(element, "length", context);
    const double extent_m = radius_m + length_m;
    return kind == "capsule" ? unless_a_point(extent_m, CapsuleShape{radius_m, length_m})
                             : unless_a_point(extent_m, CylinderShape{radius_m, length_m});
  }
  if (kind == "box") {
    const BoxShape box = box_of(element, context);
    return unless_a_point(box.size_m.maxCoeff(), box);
  }
  if (kind == "mesh") {
    return mesh_of(element, file, options, context);
  }
  fail(context, "a shape is <", shown(kind), ">, must be <box>, <cylinder>, <sphere>, <capsule> or <mesh>");
}

/// The one shape of a <collision> or <visual>.
pugi::xml_node only_shape(const pugi::xml_node& item, const std::string& context) {
  const pugi::xml_node geometry = only_child(item, "geometry", context);
  pugi::xml_node element;
  for (const pugi::xml_node& child : geometry.children()) {
    if (child.type() == pugi::node_element) {
      if (!element.empty()) {
        fail(context, "a <geometry> holds <", shown(element.name()), "> and <", shown(child.name()),
             ">, must hold one shape: write a <", item.name(), "> for each");
      }
      element = child;
    }
  }
  if (!element) {
    fail(context, "a <", item.name(), "> has no shape, must have a <geometry> with one");
  }
  return element;
}

}  // namespace

void add_shapes(const pugi::xml_node& link, const std::filesystem::path& file, const UrdfOptions& options,
                const std::string& context, LinkDescription& result) {
  const bool visual_first = options.shapes == ShapeKind::visual;
  for (const ShapeKind kind :
       {options.shapes, visual_first ? ShapeKind::collision : ShapeKind::visual}) {  // the second only if none of both
    const char* const name = kind == ShapeKind::visual ? "visual" : "collision";
    for (const pugi::xml_node& item : link.children(name)) {
      refuse_misspelt(item, {"origin", "geometry", "material", "name"}, context);
      const pugi::xml_node element = only_shape(item, context);
      if (auto shape = shape_of(element, file, options, context)) {
        result.shapes.push_back({origin_of(item, context), std::move(*shape)});
      }
    }
    if (!result.shapes.empty()) {
      result.kind = kind;
      return;
    }
  }
}

}  // namespace depthgrid::robot
