#include "depthgrid/robot/collada_geometry.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/robot/words.hpp"
#include "depthgrid/robot/xml.hpp"

namespace depthgrid::robot {

namespace {

using Indices = std::vector<std::size_t>;

/// Reads one <mesh>; `context` names file and geometry.
class GeometryReader {
 public:
  GeometryReader(const pugi::xml_node& mesh, const std::string& context) : mesh_(mesh), context_(context) {
    vertices_ = mesh.child("vertices");
    const pugi::xml_node input = vertices_.find_child_by_attribute("input", "semantic", "POSITION");
    if (!input) {
      fail(context_, "has no <vertices> with an input POSITION");
    }
    const std::string_view source = input.attribute("source").value();
    for (const pugi::xml_node& item : mesh.children("source")) {
      if (source == std::string("#") + item.attribute("id").value()) {
        read_positions(item);
        return;
      }
    }
    fail(context_, "its positions are in '", shown(source), "', which is not there");
  }

  void read(const pugi::xml_node& primitive) {
    const std::string_view kind = primitive.name();
    if (kind == "triangles") {
      read_faces(primitive, primitive.child("p"), 3);
    } else if (kind == "polylist") {
      read_polylist(primitive);
    } else if (kind == "polygons" || kind == "trifans") {
      for (const pugi::xml_node& p : primitive.children("p")) {
        read_faces(primitive, p, 0);
      }
      for (const pugi::xml_node& holed : primitive.children("ph")) {  // holes are within
        read_faces(primitive, holed.child("p"), 0);
      }
    } else if (kind == "tristrips") {
      for (const pugi::xml_node& p : primitive.children("p")) {
        const Indices strip = indices(primitive, p);
        for (std::size_t k = 0; k + 2 < strip.size(); ++k) {
          add(strip, k, 3);
        }
      }
    }
  }

  [[nodiscard]] Corners taken() noexcept { return std::move(corners_); }

 private:
  [[nodiscard]] std::size_t whole_number(std::string_view word, const char* what) const {
    const std::optional<std::size_t> number = parse_number<std::size_t>(word);
    if (!number) {
      fail(context_, what, " is '", shown(word), "', must be a whole number that is not negative");
    }
    return *number;
  }

  [[nodiscard]] std::size_t whole_number(const pugi::xml_node& node, const char* name, std::size_t otherwise) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    return !attribute.empty() ? whole_number(attribute.value(), name) : otherwise;
  }

  void read_positions(const pugi::xml_node& source) {
    const pugi::xml_node array = source.child("float_array");
    const pugi::xml_node accessor = source.child("technique_common").child("accessor");
    if (!array || accessor.attribute("source").value() != std::string("#") + array.attribute("id").value()) {
      fail(context_, "its positions are not an <accessor> to the <float_array> beside it");
    }
    std::vector<double> values;
    const std::string text = text_of(array);
    std::string_view rest = text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const std::optional<double> value = finite_number(word);
      if (!value) {
        fail(context_, "a coordinate is '", shown(word), "', must be a finite number");
      }
      values.push_back(*value);
    }
    const std::array<std::size_t, 3> places = places_of_xyz(accessor);
    const std::size_t stride = whole_number(accessor, "stride", 1);
    const std::size_t offset = whole_number(accessor, "offset", 0);
    const std::size_t count = whole_number(accessor, "count", 0);
    const std::size_t size = values.size();
    if (whole_number(array, "count", size) != size || stride <= *std::max_element(places.begin(), places.end()) ||
        offset > size || count > (size - offset) / stride) {
      fail(context_, "its array has ", size, " numbers, says count ", array.attribute("count").as_ullong(),
           "; read are ", count, " points of ", stride, " numbers from ", offset, " on");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double* const at = values.data() + offset + i * stride;
      positions_.emplace_back(at[places[0]], at[places[1]], at[places[2]]);
    }
  }

  /// Which of an accessor's numbers are x, y and z: by their names, else the first three.
  [[nodiscard]] static std::array<std::size_t, 3> places_of_xyz(const pugi::xml_node& accessor) {
    std::array<std::size_t, 3> places{0, 1, 2};
    std::size_t place = 0;
    for (const pugi::xml_node& param : accessor.children("param")) {
      const std::string_view name = param.attribute("name").value();
      if (name == "X" || name == "Y" || name == "Z") {
        places[static_cast<std::size_t>(name[0] - 'X')] = place;
      }
      ++place;
    }
    return places;
  }

  /// Which positions a list <p> names; it interleaves them with normals and the like.
  [[nodiscard]] Indices indices(const pugi::xml_node& primitive, const pugi::xml_node& p) const {
    std::size_t stride = 1;
    std::optional<std::size_t> mine;
    constexpr std::size_t kMaxInputs = 1000;
    for (const pugi::xml_node& input : primitive.children("input")) {
      const std::size_t offset = std::min(whole_number(input, "offset", 0), kMaxInputs);
      stride = std::max(stride, offset + 1);
      if (std::string_view(input.attribute("semantic").value()) == "VERTEX") {
        if (input.attribute("source").value() != std::string("#") + vertices_.attribute("id").value()) {
          fail(context_, "<", primitive.name(), "> takes its corners from '", shown(input.attribute("source").value()),
               "', must be the <vertices> beside it");
        }
        mine = offset;
      }
    }
    if (!mine) {
      fail(context_, "<", primitive.name(), "> has no input VERTEX");
    }
    Indices result;
    std::size_t count = 0;
    const std::string text = text_of(p);
    std::string_view rest = text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest), ++count) {
      const std::size_t index = whole_number(word, "an index");
      if (count % stride == *mine) {
        if (index >= positions_.size()) {
          fail(context_, "an index is ", index, ", must be below the number of positions, ", positions_.size());
        }
        result.push_back(index);
      }
    }
    if (count % stride != 0) {
      fail(context_, "<", primitive.name(), "> has ", count, " indices, must be a multiple of its inputs, ", stride);
    }
    return result;
  }

  void add(const Indices& list, std::size_t begin, std::size_t count) {
    Corners face;
    for (std::size_t k = 0; k < count; ++k) {
      face.push_back(positions_[list[begin + k]]);
    }
    add_polygon(face, corners_);
    check_size(corners_.size(), context_);
  }

  /// Faces of `size` corners each, or one face of all where `size` is 0.
  void read_faces(const pugi::xml_node& primitive, const pugi::xml_node& p, std::size_t size) {
    const Indices list = indices(primitive, p);
    if (size == 0) {
      add(list, 0, list.size());
      return;
    }
    if (list.size() != size * whole_number(primitive, "count", list.size() / size)) {
      fail(context_, "<", primitive.name(), " count='", shown(primitive.attribute("count").value()), "'> has ",
           list.size(), " corners");
    }
    for (std::size_t begin = 0; begin < list.size(); begin += size) {
      add(list, begin, size);
    }
  }

  void read_polylist(const pugi::xml_node& primitive) {
    const Indices list = indices(primitive, primitive.child("p"));
    const std::string text = text_of(primitive.child("vcount"));
    std::string_view rest = text;
    std::size_t begin = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const std::size_t size = whole_number(word, "a number of <vcount>");
      if (size > list.size() - begin) {
        fail(context_, "<polylist> has ", list.size(), " corners, its <vcount> asks for more");
      }
      add(list, begin, size);
      begin += size;
    }
    if (begin != list.size()) {
      fail(context_, "<polylist> has ", list.size(), " corners, its <vcount> only ", begin);
    }
  }

  pugi::xml_node mesh_;
  pugi::xml_node vertices_;
  const std::string& context_;
  Corners corners_;
  Corners positions_;
};

}  // namespace

Corners geometry_corners(const pugi::xml_node& geometry, const std::string& context) {
  const pugi::xml_node mesh = geometry.child("mesh");
  if (!mesh) {
    fail(context, "is no <mesh>; splines and convex hulls of others are not read: convert it to STL or OBJ");
  }
  GeometryReader reader(mesh, context);
  for (const pugi::xml_node& primitive : mesh.children()) {
    reader.read(primitive);
  }
  return reader.taken();
}

}  // namespace depthgrid::robot
