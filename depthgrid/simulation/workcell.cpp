#include "depthgrid/simulation/workcell.hpp"

#include <unordered_set>

#include "depthgrid/core/error.hpp"

namespace depthgrid::simulation {

namespace {

constexpr double kRotationError = 1e-9;

template <class Visit>
void for_each_shape(const WorkcellBody& body, Visit&& visit) {
  const auto each = [&visit](const auto& shapes) {
    for (const auto& shape : shapes) {
      visit(shape);
    }
  };
  each(body.planes);
  each(body.boxes);
  each(body.spheres);
  each(body.capsules);
}

void validate(const WorkcellBody& body) {
  try {
    bool any = body.mesh != nullptr;
    for_each_shape(body, [&any](const auto& shape) {
      simulation::validate(shape);
      any = true;
    });
    if (!any) {
      fail("has no shape");
    }
    if (body.mesh != nullptr) {
      simulation::validate(*body.mesh);
    }
    if (!body.T_world_body.matrix().allFinite()) {
      fail("pose is not finite");
    }
    const Eigen::Matrix3d& rotation = body.T_world_body.linear();
    const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (error > kRotationError || rotation.determinant() < 0) {
      fail("rotation deviates from orthonormal by ", error, ", must be at most ", kRotationError,
           ", and must not be a reflection");
    }
  } catch (const Error& error) {
    fail("body '", body.name, "': ", error.what());
  }
}

template <class Shape>
void validate_count(const WorkcellBody& body, const char* what, const std::vector<Shape>& first,
                    const std::vector<Shape>& next) {
  if (first.size() != next.size()) {
    fail("body '", body.name, "' now has ", next.size(), " ", what, ", had ", first.size(),
         "; shapes may move but neither come nor go");
  }
}

}  // namespace

WorkcellBody capsule_body(std::string name, BodyKind kind, std::span<const Capsule> capsules_world) {
  WorkcellBody body;
  body.name = std::move(name);
  body.kind = kind;
  body.capsules.assign(capsules_world.begin(), capsules_world.end());
  return body;
}

void validate(const Workcell& cell) {
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < cell.bodies.size(); ++i) {
    const WorkcellBody& body = cell.bodies[i];
    if (body.name.empty()) {
      fail("body ", i, " has no name");
    }
    if (!names.insert(body.name).second) {
      fail("two bodies are called '", body.name, "', names must be distinct");
    }
    validate(body);
  }
}

void validate_same_bodies(const Workcell& first, const Workcell& next) {
  if (first.bodies.size() != next.bodies.size()) {
    fail("the cell now has ", next.bodies.size(), " bodies, had ", first.bodies.size());
  }
  for (std::size_t i = 0; i < first.bodies.size(); ++i) {
    const WorkcellBody& before = first.bodies[i];
    const WorkcellBody& now = next.bodies[i];
    if (before.name != now.name) {
      fail("body ", i, " is now called '", now.name, "', was '", before.name, "'");
    }
    validate_count(now, "planes", before.planes, now.planes);
    validate_count(now, "boxes", before.boxes, now.boxes);
    validate_count(now, "spheres", before.spheres, now.spheres);
    validate_count(now, "capsules", before.capsules, now.capsules);
    if (before.mesh != now.mesh) {
      fail("body '", now.name, "' has another mesh than before");
    }
    validate(now);
  }
}

std::size_t body_index(const Workcell& cell, std::string_view name) {
  std::string names;
  for (std::size_t i = 0; i < cell.bodies.size(); ++i) {
    if (cell.bodies[i].name == name) {
      return i;
    }
    names.append(names.empty() ? "" : ", ").append(cell.bodies[i].name);
  }
  fail("the cell has no body '", name, "', there are ", names);
}

WorkcellBody in_world(const WorkcellBody& body) {
  if (body.mesh != nullptr) {
    fail("body '", body.name, "' has a mesh, which only keeps its own frame");
  }
  WorkcellBody result = body;
  result.T_world_body = Pose::Identity();
  const auto move = [&body](auto& shapes) {
    for (auto& shape : shapes) {
      shape = transformed(body.T_world_body, shape);
    }
  };
  move(result.planes);
  move(result.boxes);
  move(result.spheres);
  move(result.capsules);
  return result;
}

Scene scene_of(const Workcell& cell) {
  Scene scene;
  for (const WorkcellBody& body : cell.bodies) {
    const Body role = body.kind == BodyKind::robot ? Body::robot : Body::obstacle;
    for_each_shape(in_world(body), [&scene, role](const auto& shape) { scene.add(shape, role); });
  }
  return scene;
}

}  // namespace depthgrid::simulation
