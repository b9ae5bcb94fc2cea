// The shapes of a workcell as FCL objects. Included by cell_truth.cpp only.
#pragma once

#include <fcl/narrowphase/collision_object.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::workcell {

/// One solid or mesh of a body.
struct Part {
  std::unique_ptr<fcl::CollisionObjectd> object;  ///< moved
  Pose T_body_part = Pose::Identity();
  Eigen::Vector3d centre_body = Eigen::Vector3d::Zero();  ///< of a ball around the part
  double radius_m = 0;                                    ///< of that ball
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
};

/// All parts of a body but its planes. `reuse` are the parts of the same body in the last frame: their meshes stay.
[[nodiscard]] std::vector<Part> parts_of(const simulation::WorkcellBody& body, std::vector<Part> reuse);

struct PartDistance {
  double distance_m = 0;  ///< 0 when they overlap
  Eigen::Vector3d on_first_world;
  Eigen::Vector3d on_second_world;
};

/// No less than this far apart.
[[nodiscard]] double least_distance_m(const Part& first, const Part& second) noexcept;

[[nodiscard]] PartDistance distance(const Part& first, const Part& second);

/// To the half space (world frame), by the part's support in the direction of its normal.
[[nodiscard]] PartDistance distance(const Part& part, const simulation::Plane& plane_world);

}  // namespace depthgrid::workcell
