#include "depthgrid/files/control_points.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/core/text_encoding.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::files {
namespace {

/// How many values of a row say what about a point.
constexpr std::size_t kPoint = 4;    // id,x,y,z
constexpr std::size_t kSphere = 5;   // id,x,y,z,radius
constexpr std::size_t kCapsule = 8;  // id,x,y,z,radius,x2,y2,z2

/// What the columns of a file are.
struct Columns {
  bool frame = false;        ///< the first one is the frame's number
  std::size_t of_point = 0;  ///< kPoint, kSphere or kCapsule; 0: not known yet

  [[nodiscard]] std::size_t count() const noexcept { return of_point + (frame ? 1 : 0); }
};

struct CsvValue {
  std::string_view text;
  std::size_t column = 1;  ///< of its first character, from 1
};

struct Place {
  const std::string& name;
  std::size_t line;  ///< from 1; 0: the text is a single value of the command line
};

[[noreturn]] void fail_at(const Place& place, const CsvValue& value, const std::string& rule) {
  const std::string line = place.line > 0 ? "line " + std::to_string(place.line) + ", " : std::string();
  fail(place.name, ": ", line, "column ", value.column, ": ", rule);
}

/// As it can stand in a message.
std::string quoted(const CsvValue& value) { return "'" + printable_excerpt(value.text) + "'"; }

/// Values of one line between the commas, without the spaces around them.
std::vector<CsvValue> split(std::string_view line) {
  std::vector<CsvValue> values;
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

/// Lengths may say their unit: x_m. Another unit is another name.
bool is_named(std::string_view text, std::string_view name) {
  constexpr std::string_view kMetres = "_m";
  const bool is_length = name != "frame" && name != "id";
  if (is_length && text.size() > kMetres.size() &&
      equals_ignoring_case(text.substr(text.size() - kMetres.size()), kMetres)) {
    text.remove_suffix(kMetres.size());
  }
  return equals_ignoring_case(text, name);
}

/// The columns that a header names; nothing when the row is no header.
std::optional<Columns> header_columns(const std::vector<CsvValue>& values) {
  constexpr std::array<std::string_view, 1 + kCapsule> kNames = {"frame",  "id", "x",  "y", "z",
                                                                 "radius", "x2", "y2", "z2"};
  for (const bool frame : {false, true}) {
    for (const std::size_t of_point : {kPoint, kSphere, kCapsule}) {
      const Columns columns{frame, of_point};
      const auto* first = kNames.begin() + (frame ? 0 : 1);
      if (std::equal(values.begin(), values.end(), first, first + columns.count(),
                     [](const CsvValue& value, std::string_view name) { return is_named(value.text, name); })) {
        return columns;
      }
    }
  }
  return std::nullopt;
}

Columns columns_without_header(const Place& place, const std::vector<CsvValue>& values) {
  if (values.size() != kPoint && values.size() != kPoint + 1) {
    fail_at(place, values[0],
            std::to_string(values.size()) +
                " values, must be 4 (id,x,y,z) or 5 (frame,id,x,y,z); radius and x2,y2,z2 need a header row");
  }
  return {values.size() != kPoint, kPoint};
}

double length_m(const Place& place, const CsvValue& value, const char* name) {
  const auto number = parse_number<double>(value.text);
  if (!number) {
    fail_at(place, value, std::string(name) + " is " + quoted(value) + ", must be a number in metres");
  }
  if (!std::isfinite(*number)) {
    fail_at(place, value, std::string(name) + " is " + quoted(value) + ", must be finite");
  }
  if (std::abs(*number) > kLargestTranslation) {
    fail_at(place, value, std::string(name) + " is " + quoted(value) + ", must be at most 1e5 m from 0");
  }
  return *number;
}

Eigen::Vector3d position_m(const Place& place, std::span<const CsvValue> xyz) {
  return {length_m(place, xyz[0], "x"), length_m(place, xyz[1], "y"), length_m(place, xyz[2], "z")};
}

/// `values`: x,y,z and, where the columns are there, radius and x2,y2,z2.
ControlPoint point_of(const std::string& id, const Place& place, std::span<const CsvValue> values) {
  ControlPoint point{id, Capsule::point(position_m(place, values.first<3>()))};
  if (values.size() >= kSphere - 1 && !values[3].text.empty()) {
    point.capsule.radius_m = length_m(place, values[3], "radius");
    if (point.capsule.radius_m < 0) {
      fail_at(place, values[3], "radius is " + quoted(values[3]) + ", must not be negative");
    }
  }
  if (values.size() == kCapsule - 1) {
    const std::span<const CsvValue> end = values.last<3>();
    if (!std::all_of(end.begin(), end.end(), [](const CsvValue& value) { return value.text.empty(); })) {
      point.capsule.b = {length_m(place, end[0], "x2"), length_m(place, end[1], "y2"), length_m(place, end[2], "z2")};
      point.has_end = true;
    }
  }
  return point;
}

/// Ids of each frame, or of frame 0 where points do not move; not quadratic in their number.
using Ids = std::set<std::pair<int, std::string_view>>;

int frame_of(const Place& place, const Columns& columns, const std::vector<CsvValue>& values) {
  if (!columns.frame) {
    return 0;
  }
  const auto frame = parse_number<int>(values[0].text);
  if (!frame || *frame < 0) {
    fail_at(place, values[0], "frame is " + quoted(values[0]) + ", must be a whole number from 0");
  }
  return *frame;
}

void add_point(ControlPoints& points, Ids& ids, const Place& place, const Columns& columns,
               const std::vector<CsvValue>& values) {
  const std::span<const CsvValue> of_point = std::span(values).last(columns.of_point);
  const CsvValue& id = of_point[0];
  const int frame = frame_of(place, columns, values);
  if (id.text.empty()) {
    fail_at(place, id, "the id is empty, every control point needs one");
  }
  if (!is_printable(id.text)) {
    fail_at(place, id, "id " + quoted(id) + " holds a character that cannot be printed, ids must not");
  }
  if (!ids.emplace(frame, id.text).second) {
    fail_at(place, id, "id " + quoted(id) + " occurs twice, ids must be distinct");
  }
  std::vector<ControlPoint>& list = columns.frame ? points.of_frame[frame] : points.fixed;
  list.push_back(point_of(std::string(id.text), place, of_point.subspan(1)));
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
  text = without_byte_order_mark(text, name + ": ");
  ControlPoints points;
  Columns columns;  // as the first row has them
  Ids ids;
  std::size_t line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::vector<CsvValue> values = split(line.substr(0, line.find('#')));
    if (values.size() == 1 && values[0].text.empty()) {
      continue;
    }
    const Place place{name, line_number};
    if (columns.of_point == 0) {
      if (const auto header = header_columns(values)) {
        columns = *header;
        continue;
      }
      columns = columns_without_header(place, values);
    }
    if (values.size() != columns.count()) {
      fail_at(place, values[0],
              std::to_string(values.size()) + " values, must be " + std::to_string(columns.count()) +
                  " as in the first row");
    }
    add_point(points, ids, place, columns, values);
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
  const std::string name = "control point '" + printable_excerpt(text) + "'";
  const Place place{name, 0};
  if (id.empty() || !is_printable(id)) {
    fail(name, ": id '", printable_excerpt(id), "' is empty or holds a character that cannot be printed");
  }
  const std::vector<CsvValue> values = split(text);
  if (values.size() != kPoint - 1 && values.size() != kSphere - 1 && values.size() != kCapsule - 1) {
    fail_at(place, values[0],
            std::to_string(values.size()) +
                " values, must be 3 (x,y,z in metres), 4 (with a radius) or 7 (x,y,z,radius,x2,y2,z2)");
  }
  return point_of(id, place, values);
}

}  // namespace depthgrid::files
