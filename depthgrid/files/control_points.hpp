// Control points: the points, spheres and capsules of the robot whose distances are asked for.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/capsule.hpp"

namespace depthgrid::files {

/// A named point, sphere or capsule, in the frame that its user says (world or floor).
struct ControlPoint {
  std::string id;
  Capsule capsule;
  bool has_end = false;  ///< a second end was given; without one it is the first
};

/// Points that stay where they are, or points given anew for every frame of a recording. One of the two is empty.
struct ControlPoints {
  std::vector<ControlPoint> fixed;
  std::map<int, std::vector<ControlPoint>> of_frame;  ///< by frame number, as in the names of the image files

  /// The points of a frame, in the file's order; nothing when the points move and none is given for this frame.
  [[nodiscard]] std::span<const ControlPoint> at(int frame_number) const noexcept;
};

/// Reads comma-separated control points, metres: columns id,x,y,z, or frame,id,x,y,z for points that move. A first row
/// with these names (x,y,z or x_m,y_m,z_m) is a header and may be left out. Spheres and capsules need it:
/// id,x,y,z,radius or id,x,y,z,radius,x2,y2,z2, with or without frame before; radius may be empty (0), and x2,y2,z2
/// together (no capsule). Blank lines and everything behind # are skipped, spaces around values too. Throws Error that
/// names file, line, column (counted in characters from 1) and value: a wrong number of values, no number, NaN or
/// infinity, a coordinate or radius beyond kLargestTranslation, a negative radius, an empty or doubled id (in the same
/// frame) or one that cannot be printed (UTF-8 without control characters), a file without points.
ControlPoints load_control_points(const std::filesystem::path& file);

/// The same from text. `name` stands for the file in messages.
ControlPoints parse_control_points(std::string_view text, const std::string& name);

/// One point from "x,y,z", "x,y,z,radius" or "x,y,z,radius,x2,y2,z2" in metres, as given on a command line. Throws
/// Error as above.
ControlPoint parse_control_point(std::string_view text, const std::string& id);

}  // namespace depthgrid::files
