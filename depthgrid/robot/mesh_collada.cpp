// COLLADA: what its scene shows, node by node.
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/collada_geometry.hpp"
#include "depthgrid/robot/mesh_formats.hpp"
#include "depthgrid/robot/words.hpp"
#include "depthgrid/robot/xml.hpp"

namespace depthgrid::robot {

namespace {

using Eigen::Vector3d;

/// Where a node stands. Transforms that are not read matter only where a geometry hangs below them.
struct NodePlace {
  Eigen::Affine3d T_scene_node = Eigen::Affine3d::Identity();
  std::string unread;
  int depth = 0;
};

class ColladaScene {
 public:
  ColladaScene(const pugi::xml_node& root, const std::string& context) : root_(root), context_(context) {
    for (const pugi::xml_node& library : root.children("library_geometries")) {
      for (const pugi::xml_node& geometry : library.children("geometry")) {
        geometries_.emplace(geometry.attribute("id").value(), geometry);
      }
    }
    for (const char* name : {"library_nodes", "library_visual_scenes"}) {
      for (const pugi::xml_node& library : root.children(name)) {
        note_nodes(library);
      }
    }
  }

  [[nodiscard]] Corners read() {
    NodePlace place;
    place.T_scene_node.linear() *= unit_m();
    for (const pugi::xml_node& node : visual_scene().children("node")) {
      walk(node, place);
    }
    if (corners_.empty()) {
      fail(context_, "its scene shows no mesh");
    }
    return std::move(corners_);
  }

 private:
  void note_nodes(const pugi::xml_node& parent) {
    for (const pugi::xml_node& node : parent.children()) {
      if (const std::string_view name = node.name(); name == "node" || name == "visual_scene") {
        (name == "node" ? nodes_ : scenes_).emplace(node.attribute("id").value(), node);
        note_nodes(node);
      }
    }
  }

  [[nodiscard]] double unit_m() const {
    const pugi::xml_attribute metre = root_.child("asset").child("unit").attribute("meter");
    const double unit = !metre.empty() ? finite_number(metre.value()).value_or(0) : 1.0;
    if (!(unit > 0)) {
      fail(context_, "its unit is '", shown(metre.value()), "' m, must be a positive number");
    }
    return unit;
  }

  [[nodiscard]] pugi::xml_node visual_scene() const {
    const pugi::xml_node instance = root_.child("scene").child("instance_visual_scene");
    if (!instance && scenes_.size() == 1) {
      return scenes_.begin()->second;
    }
    return referred(scenes_, instance, "visual scene");
  }

  /// What `instance` refers to by its url.
  [[nodiscard]] pugi::xml_node referred(const std::map<std::string, pugi::xml_node>& items,
                                        const pugi::xml_node& instance, const char* what) const {
    const std::string url = instance.attribute("url").value();
    const auto found = url.starts_with('#') ? items.find(url.substr(1)) : items.end();
    if (found == items.end()) {
      fail(context_, "its ", what, " is '", shown(url), "', which is not in this file");
    }
    return found->second;
  }

  template <int kCount>
  [[nodiscard]] Eigen::Matrix<double, kCount, 1> numbers(const pugi::xml_node& element) const {
    Eigen::Matrix<double, kCount, 1> result;
    const std::string text = text_of(element);
    std::string_view rest = text;
    for (double& number : result) {
      const std::string_view word = next_word(rest);
      const std::optional<double> value = finite_number(word);
      if (!value) {
        fail(context_, "<", element.name(), "> holds '", shown(word), "', must be ", kCount, " finite numbers");
      }
      number = *value;
    }
    if (!next_word(rest).empty()) {
      fail(context_, "<", element.name(), "> holds more than ", kCount, " numbers");
    }
    return result;
  }

  void move(NodePlace& place, const pugi::xml_node& element) const {
    const std::string_view kind = element.name();
    Eigen::Affine3d& T = place.T_scene_node;
    if (kind == "translate") {
      T.translate(numbers<3>(element));
    } else if (kind == "scale") {
      T.scale(numbers<3>(element));
    } else if (kind == "rotate") {
      const Eigen::Vector4d axis_angle = numbers<4>(element);
      const Vector3d axis = axis_angle.head<3>();
      if (axis_angle[3] != 0 && !(axis.stableNorm() > 0)) {
        fail(context_, "<rotate> has axis (", axis.transpose(), "), must not be zero");
      }
      T.rotate(Eigen::AngleAxisd(axis_angle[3] * std::numbers::pi / 180, axis.stableNormalized()));
    } else if (kind == "matrix") {
      const Eigen::Matrix<double, 16, 1> m = numbers<16>(element);
      if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
        fail(context_, "<matrix> ends in the row ", m.tail<4>().transpose(), ", must be 0 0 0 1");
      }
      T = T * Eigen::Affine3d(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data()));
    } else if (kind == "skew" || kind == "lookat") {
      place.unread = kind;
    }
  }

  void walk(const pugi::xml_node& node, NodePlace place) {
    constexpr int kMaxDepth = 100;
    constexpr std::size_t kMaxNodes = 100'000;
    if (++place.depth > kMaxDepth || ++visited_ > kMaxNodes) {
      fail(context_, "its nodes instance each other without end, or more than ", kMaxDepth, " deep, or ", kMaxNodes,
           " times");
    }
    for (const pugi::xml_node& child : node.children()) {
      move(place, child);
    }
    for (const pugi::xml_node& child : node.children()) {
      const std::string_view kind = child.name();
      if (kind == "node") {
        walk(child, place);
      } else if (kind == "instance_node") {
        walk(referred(nodes_, child, "node"), place);
      } else if (kind == "instance_geometry") {
        add(referred(geometries_, child, "geometry"), place);
      } else if (kind == "instance_controller") {
        fail(context_,
             "its mesh hangs on a skeleton (<instance_controller>), which is not read: convert it to STL or OBJ");
      }
    }
  }

  void add(const pugi::xml_node& geometry, const NodePlace& place) {
    if (!place.unread.empty()) {
      fail(context_, "a mesh is moved by <", place.unread, ">, which is not read: convert it to STL or OBJ");
    }
    const std::string id = geometry.attribute("id").value();
    auto found = read_.find(id);
    if (found == read_.end()) {
      found = read_.emplace(id, geometry_corners(geometry, context_ + "geometry '" + shown(id) + "': ")).first;
    }
    check_size(corners_.size() + found->second.size(), context_);
    for (const Vector3d& corner : found->second) {
      corners_.push_back(place.T_scene_node * corner);
    }
  }

  pugi::xml_node root_;
  const std::string& context_;
  std::map<std::string, pugi::xml_node> geometries_, nodes_, scenes_;
  std::map<std::string, Corners> read_;  ///< geometries, by their ids
  Corners corners_;
  std::size_t visited_ = 0;
};

}  // namespace

Corners collada_corners(std::string_view text, const std::string& context) {
  pugi::xml_document document;
  return ColladaScene(parse_xml(text, "COLLADA", context, document), context).read();
}

}  // namespace depthgrid::robot
