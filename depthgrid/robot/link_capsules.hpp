// The capsules that contain a robot's links.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::robot {

/// A capsule fixed to a link of a RobotModel, in the link's frame.
struct LinkCapsule {
  std::size_t link = 0;
  Capsule capsule{};
};

struct CapsuleOptions {
  /// Links that get no capsule: a floor plate that came with the file, for one. Cameras see them as obstacles.
  std::vector<std::string> left_out;
  double margin_m = 0;  ///< added to every radius
};

/// Capsules that contain every shape of every link, link by link: a sphere is one, a cylinder whose ends are centres of
/// spheres at least as wide is one with them (the way to write a capsule in URDF), other cylinders, and meshes, get the
/// smallest that is found around them, boxes up to eight. Reads the files of meshes. Throws Error when one cannot be
/// read, a name to leave out is no link's, or the margin is negative or not finite.
[[nodiscard]] std::vector<LinkCapsule> link_capsules(const RobotModel& model, const CapsuleOptions& options = {});

/// The capsules in the world; both spans have the same size. T_world_link: as RobotModel::link_poses() gives them.
void place(std::span<const LinkCapsule> capsules, std::span<const Pose> T_world_link,
           std::span<Capsule> capsules_world) noexcept;

}  // namespace depthgrid::robot
