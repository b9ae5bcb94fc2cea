// What can be said of a robot's file: joints, links, their capsules against their shapes, and what is missing.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/robot/robot_model.hpp"
#include "program/robot_options.hpp"

namespace depthgrid::program {

/// Frame of the link, metres. What could not be measured is empty.
struct LinkSurvey {
  std::size_t link = 0;  ///< of the model
  std::vector<std::string> shapes;
  std::vector<Capsule> capsules;
  std::vector<Eigen::Vector3d> triangles;        ///< of these shapes: three corners after the other
  std::vector<Eigen::Vector3d> other_triangles;  ///< of its shapes of the other kind, where it has both
  std::optional<double> volume_ratio;            ///< the sum of the capsules to the shape, where it is one that closes
  std::optional<double> inside_m;        ///< how deep the outermost corner lies in the capsules; below 0: outside
  std::optional<double> other_inside_m;  ///< the same of the shapes of the other kind
};

struct MissingMesh {
  std::string link;
  std::string name;  ///< as the robot's file has it
  std::string file;  ///< where it was looked for; empty: its package is not known
};

struct RobotSurvey {
  robot::RobotDescription description;
  robot::RobotModel model;
  std::vector<LinkSurvey> links;    ///< those asked for, in the model's order
  std::vector<std::size_t> joints;  ///< of the description, those that carry these links
  std::vector<MissingMesh> missing_meshes;
  std::string other_note;  ///< why the shapes of the other kind are not compared; empty: they are, or there are none
  std::optional<std::size_t> tip;
};

/// `tip`: only the links on the way from the root to this one; empty: all. Meshes that are not there are listed, their
/// links have no capsules. Throws Error where the file, or a mesh that is there, is broken.
[[nodiscard]] RobotSurvey survey_robot(const RobotFileOptions& options, const std::string& tip);

}  // namespace depthgrid::program
