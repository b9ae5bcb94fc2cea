#include "program/distances/point_options.hpp"

#include <set>

#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

files::ControlPoint command_line_point(const std::string& text, std::size_t number) {
  std::string id = "p" + std::to_string(number);
  std::string coordinates = text;
  if (const auto equals = text.find('='); equals != std::string::npos) {
    id = text.substr(0, equals);
    coordinates = text.substr(equals + 1);
    if (id.empty()) {
      fail_usage("--point ", text, ": the name before '=' is empty");
    }
  }
  try {
    return files::parse_control_point(coordinates, id);
  } catch (const Error& error) {
    throw UsageError("--point " + text + ": " + error.what());
  }
}

/// Names of one frame differ; those of a file do already.
void check_names(const Points& points) {
  std::set<std::string> names;
  for (const auto& point : points.of_command_line) {
    if (!names.insert(point.id).second) {
      fail_usage("--point: two control points are called '", point.id, "'; names must differ");
    }
  }
  const auto check = [&names](std::span<const files::ControlPoint> of_file) {
    for (const auto& point : of_file) {
      if (names.contains(point.id)) {
        fail_usage("--point: '", point.id, "' is also a control point of the file of --points; names must differ");
      }
    }
  };
  check(points.of_file.fixed);
  for (const auto& [frame, of_frame] : points.of_file.of_frame) {
    check(of_frame);
  }
}

void refuse_shape(const files::ControlPoint& point) {
  if (point.has_end || point.capsule.radius_m != 0) {
    fail_usage("control point '", point.id, "' has a ", point.has_end ? "second end" : "radius",
               ", which only --method search knows");
  }
}

}  // namespace

std::vector<files::ControlPoint> Points::at(int frame_number) const {
  std::vector<files::ControlPoint> points = of_command_line;
  const auto more = of_file.at(frame_number);
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

Points control_points(const PointOptions& options) {
  Points points;
  for (const auto& text : options.texts) {
    points.of_command_line.push_back(command_line_point(text, points.of_command_line.size() + 1));
  }
  if (!options.file.empty()) {
    points.of_file = files::load_control_points(options.file);
  } else if (points.of_command_line.empty()) {
    fail_usage("no control point: give --point x,y,z (metres, repeatable) or --points FILE.csv");
  }
  check_names(points);
  return points;
}

void refuse_shapes(const Points& points) {
  for (const auto& point : points.of_command_line) {
    refuse_shape(point);
  }
  for (const auto& point : points.of_file.fixed) {
    refuse_shape(point);
  }
  for (const auto& [frame, of_frame] : points.of_file.of_frame) {
    for (const auto& point : of_frame) {
      refuse_shape(point);
    }
  }
}

std::vector<files::ControlPoint> in_world(std::vector<files::ControlPoint> points, const Pose& T_world_output) {
  for (files::ControlPoint& point : points) {
    point.capsule.a = T_world_output * point.capsule.a;
    point.capsule.b = T_world_output * point.capsule.b;
  }
  return points;
}

}  // namespace depthgrid::program
