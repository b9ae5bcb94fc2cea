// Robots from URDF files.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "depthgrid/robot/robot_description.hpp"

namespace depthgrid::robot {

struct UrdfOptions {
  /// Where package://NAME/... is. A name that is not listed is looked for around the URDF file: the folder that holds
  /// it, the one above that, or one higher up or beside these that holds a package.xml. Meshes may lie in these folders
  /// and in the robot's own: the nearest one around the URDF file that holds a package.xml, else the one that holds the
  /// file.
  std::map<std::string, std::filesystem::path> packages;
  /// Whether files of meshes must exist. Where they need not, a package that is not found is no error either, and the
  /// mesh's file is its name.
  bool require_meshes = true;
  /// The shapes that count; those of the other kind only for links that have none of this one.
  ShapeKind shapes = ShapeKind::collision;
};

/// Reads a URDF file. Shapes are the collision shapes of each link, and the visual ones of links that have none, or
/// the other way round (UrdfOptions::shapes); one without any extent (a box of size 0 0 0) is left out. Joints are
/// fixed, revolute, continuous or prismatic, or floating or planar below nothing but a link without shapes, which then
/// is left out: T_world_base says where its child is. A greatest speed of 0 is not stated. Names of meshes may be
/// package://, file:// or relative to the file.
///
/// What distances do not need is not looked at: inertia, materials, damping, safety controllers, and visual shapes of
/// links that have others. Throws Error, naming the file, when it cannot be read, is no URDF, holds a number that is
/// none or a length beyond 1000 m, spells an element nearly as one that is read, or names a link, a package or a mesh
/// that is not there. RobotModel checks the tree. Prints nothing; may be called from many threads.
[[nodiscard]] RobotDescription load_urdf(const std::filesystem::path& file, const UrdfOptions& options = {});

/// The same from text. `source` stands for the file in messages, and relative names begin in its folder.
[[nodiscard]] RobotDescription parse_urdf(const std::string& text, const std::filesystem::path& source,
                                          const UrdfOptions& options = {});

}  // namespace depthgrid::robot
