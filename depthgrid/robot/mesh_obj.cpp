// Wavefront OBJ: v and f.
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/text_encoding.hpp"
#include "depthgrid/robot/mesh_formats.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

using Eigen::Vector3d;

/// Reads a file line by line; faces name vertices that stand before them.
class ObjReader {
 public:
  explicit ObjReader(const std::string& context) : context_(context) {}

  void read_line(std::string_view line) {
    ++line_;
    std::string_view rest = line.substr(0, line.find('#'));
    const std::string_view key = next_word(rest);
    if (key == "v") {
      add_vertex(rest);
    } else if (key == "f") {
      add_face(rest);
    } else if (key == "curv" || key == "surf") {
      fail(place(), "free-form curves and surfaces are not read: convert them to faces");
    }
  }

  [[nodiscard]] Corners taken() noexcept { return std::move(corners_); }

 private:
  [[nodiscard]] std::string place() const { return context_ + "line " + std::to_string(line_) + ": "; }

  void add_vertex(std::string_view rest) {
    Vector3d p;
    for (double& coordinate : p) {
      const std::string_view word = next_word(rest);
      const std::optional<double> number = finite_number(word);
      if (!number) {
        fail(place(), "a coordinate is '", shown(word), "', must be a finite number");
      }
      coordinate = *number;
    }
    vertices_.push_back(p);
  }

  void add_face(std::string_view rest) {
    Corners face;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      // v, v/vt, v//vn or v/vt/vn; from 1 on, or from -1 back
      const auto index = parse_number<long long>(word.substr(0, word.find('/')));
      const auto count = static_cast<long long>(vertices_.size());
      if (!index || *index == 0 || *index > count || *index < -count) {
        fail(place(), "a face's corner is '", shown(word), "', must be one of the ", count, " vertices before it");
      }
      face.push_back(vertices_[static_cast<std::size_t>(*index > 0 ? *index - 1 : count + *index)]);
    }
    add_polygon(face, corners_);
    check_size(corners_.size(), context_);
  }

  const std::string& context_;
  Corners corners_;
  std::size_t line_ = 0;
  Corners vertices_;
};

}  // namespace

Corners obj_corners(std::string_view text, const std::string& context) {
  ObjReader reader(context);
  text = without_byte_order_mark(text, context);
  std::string joined;
  while (!text.empty()) {
    const std::string_view line = next_line(text);
    if (line.ends_with('\\')) {  // goes on in the next line
      joined.append(line.substr(0, line.size() - 1)).push_back(' ');
    } else if (joined.empty()) {
      reader.read_line(line);
    } else {
      reader.read_line(joined.append(line));
      joined.clear();
    }
  }
  reader.read_line(joined);
  return reader.taken();
}

}  // namespace depthgrid::robot
