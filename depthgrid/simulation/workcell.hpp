// Everything that stands and moves in a robot's workcell at one instant: named bodies with poses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "depthgrid/simulation/shapes.hpp"
#include "depthgrid/simulation/triangle_mesh.hpp"

namespace depthgrid::simulation {

enum class BodyKind : std::uint8_t { room, object, robot, person };

/// A body is the union of its solids and its mesh, all given in the frame of the body (which for bodies without a pose
/// of their own is the world). A rigid body moves by its pose; a person's capsules are replaced instead.
struct WorkcellBody {
  std::string name;
  BodyKind kind = BodyKind::object;
  Pose T_world_body = Pose::Identity();
  std::vector<Plane> planes{};
  std::vector<Box> boxes{};
  std::vector<Sphere> spheres{};
  std::vector<Capsule> capsules{};
  std::shared_ptr<const TriangleMesh> mesh{};  ///< shared between copies of the cell; must not change
};

struct Workcell {
  std::vector<WorkcellBody> bodies;
};

/// A body of capsules in the world frame: a person, or an arm without meshes.
[[nodiscard]] WorkcellBody capsule_body(std::string name, BodyKind kind, std::span<const Capsule> capsules_world);

/// Throws Error unless names are distinct and not empty, each body has a shape, poses are rigid and finite, and every
/// shape and mesh is valid.
void validate(const Workcell& cell);

/// Throws Error that names the difference unless `next` has the bodies of `first` in the same order, with as many
/// shapes of each type and the same meshes: what may change from frame to frame is poses and measures.
void validate_same_bodies(const Workcell& first, const Workcell& next);

/// Index of the body called `name`. Throws Error that lists the names there are.
[[nodiscard]] std::size_t body_index(const Workcell& cell, std::string_view name);

/// The same body with all solids in the world frame and the identity as pose. The mesh keeps its own frame: bodies with
/// a mesh are refused with Error.
[[nodiscard]] WorkcellBody in_world(const WorkcellBody& body);

/// The cell as an analytic scene: kind robot becomes Body::robot, everything else an obstacle. Throws Error for a cell
/// with a mesh.
[[nodiscard]] Scene scene_of(const Workcell& cell);

}  // namespace depthgrid::simulation
