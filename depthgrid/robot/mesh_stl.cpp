// STL, of both kinds.
#include <bit>
#include <cstdint>
#include <cstring>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/text_encoding.hpp"
#include "depthgrid/robot/mesh_formats.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kHeaderBytes = 84;    // 80 of text and the number of triangles
constexpr std::size_t kTriangleBytes = 50;  // normal, three corners, two bytes of attributes

/// Numbers in an STL are little-endian.
template <class Number>
Number number_at(std::string_view bytes, std::size_t offset) noexcept {
  static_assert(std::endian::native == std::endian::little && sizeof(Number) == 4);
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof(Number));
  return number;
}

Corners binary_corners(std::string_view bytes, std::size_t count) {
  Corners corners;
  corners.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 1; k <= 3; ++k) {  // the normal is the first vector
      const std::size_t at = kHeaderBytes + kTriangleBytes * i + 12 * k;
      corners.emplace_back(number_at<float>(bytes, at), number_at<float>(bytes, at + 4),
                           number_at<float>(bytes, at + 8));
    }
  }
  return corners;
}

/// `rest` is moved behind the three numbers.
Vector3d vertex(std::string_view& rest, const std::string& context) {
  Vector3d p;
  for (double& coordinate : p) {
    const std::string_view word = next_word(rest);
    const std::optional<double> number = finite_number(word);
    if (!number) {
      fail(context, "ASCII STL: a coordinate of a vertex is '", shown(word), "', must be a finite number");
    }
    coordinate = *number;
  }
  return p;
}

Corners ascii_corners(std::string_view text, const std::string& context) {
  Corners corners;
  Corners facet;
  bool in_facet = false;
  bool in_solid = false;
  for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
    const std::string key = lower_case(word);
    if (key == "solid" || key == "endsolid") {
      in_solid = key == "solid" && !in_facet;
      next_line(text);  // its name
    } else if (key == "facet") {
      in_facet = true;
    } else if (key == "vertex" && in_facet) {
      facet.push_back(vertex(text, context));
    } else if (key == "endfacet" && in_facet) {
      if (facet.size() < 3) {
        fail(context, "ASCII STL: a facet has ", facet.size(), " vertices, must have 3");
      }
      add_polygon(facet, corners);
      check_size(corners.size(), context);
      facet.clear();
      in_facet = false;
    } else if (!in_facet && !in_solid && !corners.empty() && lower_case(text).find("facet") == std::string::npos) {
      break;  // bytes after the last solid
    } else if (!in_facet) {
      fail(context, "ASCII STL: '", shown(word), "' stands where 'facet' or 'endsolid' must");
    }
  }
  if (in_solid || in_facet) {
    fail(context, "ASCII STL: ends without 'endsolid'; is it cut off?");
  }
  return corners;
}

}  // namespace

Corners stl_corners(std::string_view bytes, const std::string& context) {
  const bool binary_size = bytes.size() >= kHeaderBytes;
  const std::size_t count = binary_size ? number_at<std::uint32_t>(bytes, 80) : 0;
  const std::size_t needed = kHeaderBytes + kTriangleBytes * count;
  // Headers of binary files may begin with "solid", too; but then a zero byte follows, in the number at the latest.
  const bool marked = bytes.starts_with("\xEF\xBB\xBFsolid");
  std::string_view beginning = bytes.substr(marked ? 3 : 0, kHeaderBytes);
  const bool text = lower_case(next_word(beginning)).starts_with("solid") &&
                    bytes.substr(0, kHeaderBytes).find('\0') == std::string_view::npos && needed != bytes.size();
  if (text) {
    return ascii_corners(without_byte_order_mark(bytes, context), context);
  }
  if (!binary_size) {
    fail(context, "is no STL: it does not begin with 'solid', and has ", bytes.size(),
         " bytes, a binary one has at least ", kHeaderBytes);
  }
  if (needed > bytes.size()) {
    fail(context, "is no STL or is cut off: it does not begin with 'solid', and a binary one of ", count,
         " triangles has ", needed, " bytes, this has ", bytes.size());
  }
  check_size(3 * count, context);
  return binary_corners(bytes, count);  // what follows the last triangle is no part of the format: exporters add bytes
}

}  // namespace depthgrid::robot
