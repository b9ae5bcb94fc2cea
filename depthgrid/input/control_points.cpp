#include "depthgrid/input/control_points.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/input/number_parsing.hpp"
#include "depthgrid/input/text_file.hpp"

namespace depthgrid::input {
namespace {

constexpr std::size_t kFixedColumns = 4;   // id,x,y,z
constexpr std::size_t kMovingColumns = 5;  // frame,id,x,y,z

struct Value {
  std::string_view text;
  std::size_t column = 1;  ///< of its first character, from 1
};

struct Place {
  const std::string& name;
  std::size_t line;  ///< from 1; 0: the text is a single value of the command line
};

[[noreturn]] void fail_at(const Place& place, const Value& value, const std::string& rule) {
  const std::string line = place.line > 0 ? "line " + std::to_string(place.line) + ", " : std::string();
  fail(place.name, ": ", line, "column ", value.column, ": ", rule);
}

/// Values of one line between the commas, without the spaces around them.
std::vector<Value> split(std::string_view line) {
  std::vector<Value> values;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    const std::string_view text = trimmed(line.substr(begin, comma - begin));
    values.push_back({text, static_cast<std::size_t>(text.data() - line.data()) + 1});
    if (comma == line.size()) {
      return values;
    }
    begin = comma + 1;
  }
}

bool equals_ignoring_case(std::string_view text, std::string_view lower) {
  return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

bool is_header(const std::vector<Value>& values) {
  const std::size_t skip = values.size() == kFixedColumns ? 1 : 0;
  if (values.size() != kFixedColumns && values.size() != kMovingColumns) {
    return false;
  }
  constexpr std::array<std::string_view, kMovingColumns> kNames = {"frame", "id", "x", "y", "z"};
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!equals_ignoring_case(values[k].text, kNames[k + skip])) {
      return false;
    }
  }
  return true;
}

double coordinate_m(const Place& place, const Value& value, char axis) {
  const auto number = parse_number<double>(value.text);
  if (!number) {
    fail_at(place, value, std::string(1, axis) + " is '" + std::string(value.text) + "', must be a number in metres");
  }
  if (!std::isfinite(*number)) {
    fail_at(place, value, std::string(1, axis) + " is '" + std::string(value.text) + "', must be finite");
  }
  return *number;
}

Eigen::Vector3d position_m(const Place& place, std::span<const Value> xyz) {
  return {coordinate_m(place, xyz[0], 'x'), coordinate_m(place, xyz[1], 'y'), coordinate_m(place, xyz[2], 'z')};
}

std::vector<ControlPoint>& points_of(ControlPoints& points, const Place& place, const std::vector<Value>& values) {
  if (values.size() == kFixedColumns) {
    return points.fixed;
  }
  const auto frame = parse_number<int>(values[0].text);
  if (!frame || *frame < 0) {
    fail_at(place, values[0], "frame is '" + std::string(values[0].text) + "', must be a whole number from 0");
  }
  return points.of_frame[*frame];
}

void add_point(ControlPoints& points, const Place& place, const std::vector<Value>& values) {
  const Value& id = values[values.size() - kFixedColumns];
  std::vector<ControlPoint>& list = points_of(points, place, values);
  if (id.text.empty()) {
    fail_at(place, id, "the id is empty, every control point needs one");
  }
  if (std::any_of(list.begin(), list.end(), [&](const ControlPoint& point) { return point.id == id.text; })) {
    fail_at(place, id, "id '" + std::string(id.text) + "' occurs twice, ids must be distinct");
  }
  list.push_back({std::string(id.text), position_m(place, std::span(values).last<3>())});
}

}  // namespace

std::span<const ControlPoint> ControlPoints::at(int frame_number) const noexcept {
  if (of_frame.empty()) {
    return fixed;
  }
  const auto found = of_frame.find(frame_number);
  return found != of_frame.end() ? std::span<const ControlPoint>(found->second) : std::span<const ControlPoint>();
}

ControlPoints parse_control_points(std::string_view text, const std::string& name) {
  ControlPoints points;
  std::size_t columns = 0;  // as the first row has them
  std::size_t line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::vector<Value> values = split(line.substr(0, line.find('#')));
    if (values.size() == 1 && values[0].text.empty()) {
      continue;
    }
    const Place place{name, line_number};
    if (columns == 0) {
      if (values.size() != kFixedColumns && values.size() != kMovingColumns) {
        fail_at(place, values[0],
                std::to_string(values.size()) + " values, must be 4 (id,x,y,z) or 5 (frame,id,x,y,z)");
      }
      columns = values.size();
      if (is_header(values)) {
        continue;
      }
    }
    if (values.size() != columns) {
      fail_at(place, values[0],
              std::to_string(values.size()) + " values, must be " + std::to_string(columns) + " as in the first row");
    }
    add_point(points, place, values);
  }
  if (points.fixed.empty() && points.of_frame.empty()) {
    fail(name, ": holds no control point, needs at least one row id,x,y,z");
  }
  return points;
}

ControlPoints load_control_points(const std::filesystem::path& file) {
  return parse_control_points(read_text_file(file), file.string());
}

ControlPoint parse_control_point(std::string_view text, const std::string& id) {
  const std::string name = "control point '" + std::string(text) + "'";
  const Place place{name, 0};
  const std::vector<Value> values = split(text);
  if (values.size() != 3) {
    fail_at(place, values[0], std::to_string(values.size()) + " values, must be 3 (x,y,z in metres)");
  }
  return {id, position_m(place, values)};
}

}  // namespace depthgrid::input
