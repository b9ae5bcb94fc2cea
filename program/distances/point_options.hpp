// The control points that a command line names.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/files/control_points.hpp"

namespace depthgrid::program {

struct PointOptions {
  std::vector<std::string> texts;  ///< x,y,z or name=x,y,z, or with radius and end
  std::string file;                ///< CSV; empty: none
};

/// Control points of the command line, in every frame, and those of a file, which may move.
struct Points {
  std::vector<files::ControlPoint> of_command_line;
  files::ControlPoints of_file;

  /// Their names differ.
  [[nodiscard]] std::vector<files::ControlPoint> at(int frame_number) const;
};

/// Throws UsageError when there is none, one cannot be read, or two of one frame have the same name, and Error where
/// the file is broken.
Points control_points(const PointOptions& options);

/// For methods that know points only: throws UsageError that names the first sphere or capsule.
void refuse_shapes(const Points& points);

/// The points, given in the output frame, in the world's.
std::vector<files::ControlPoint> in_world(std::vector<files::ControlPoint> points, const Pose& T_world_output);

}  // namespace depthgrid::program
