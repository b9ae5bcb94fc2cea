#include "lab/workcell/fcl_parts.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>

#include "depthgrid/core/error.hpp"

namespace depthgrid::workcell {

using simulation::Box;
using simulation::Plane;
using simulation::Sphere;
using simulation::TriangleMesh;
using simulation::WorkcellBody;

namespace {

using MeshModel = fcl::BVHModel<fcl::OBBRSSd>;

Part part(const std::shared_ptr<fcl::CollisionGeometryd>& geometry, const Pose& T_body_part, double radius_m) {
  Part result;
  result.object = std::make_unique<fcl::CollisionObjectd>(geometry);
  result.T_body_part = T_body_part;
  result.centre_body = T_body_part.translation();
  result.radius_m = radius_m;
  return result;
}

Part part(const Box& box) {
  const Eigen::Vector3d size_m = 2 * box.half_size_m;
  return part(std::make_shared<fcl::Boxd>(size_m), box.T_world_box, box.half_size_m.norm());
}

Part part(const Sphere& sphere) {
  Pose T_body_part = Pose::Identity();
  T_body_part.translation() = sphere.centre_world;
  return part(std::make_shared<fcl::Sphered>(sphere.radius_m), T_body_part, sphere.radius_m);
}

/// FCL's capsules lie along z with the origin in the middle.
Part part(const Capsule& capsule) {
  const Eigen::Vector3d ab = capsule.b - capsule.a;
  if (ab.norm() == 0) {
    return part(Sphere{capsule.a, capsule.radius_m});
  }
  Pose T_body_part = Pose::Identity();
  T_body_part.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ab).toRotationMatrix();
  T_body_part.translation() = 0.5 * (capsule.a + capsule.b);
  return part(std::make_shared<fcl::Capsuled>(capsule.radius_m, ab.norm()), T_body_part,
              0.5 * ab.norm() + capsule.radius_m);
}

Part part(const TriangleMesh& mesh) {
  auto model = std::make_shared<MeshModel>();
  model->beginModel(static_cast<int>(mesh.triangles.size()), static_cast<int>(mesh.vertices_m.size()));
  for (const Eigen::Vector3i& corners : mesh.triangles) {
    const auto vertex = [&mesh, &corners](int i) {
      return Eigen::Vector3d(mesh.vertices_m[static_cast<std::size_t>(corners[i])].cast<double>());
    };
    model->addTriangle(vertex(0), vertex(1), vertex(2));
  }
  model->endModel();
  model->computeLocalAABB();
  Part result = part(model, Pose::Identity(), model->aabb_radius);
  result.centre_body = model->aabb_center;
  return result;
}

/// The point of the part that lies farthest against the normal.
Eigen::Vector3d lowest_point(const Part& part, const Eigen::Vector3d& normal) {
  const fcl::CollisionGeometryd& geometry = *part.object->collisionGeometry();
  const auto& T = part.object->getTransform();
  const Eigen::Vector3d down = T.linear().transpose() * -normal;
  switch (geometry.getNodeType()) {
    case fcl::GEOM_BOX: {
      const Eigen::Vector3d half_m = 0.5 * dynamic_cast<const fcl::Boxd&>(geometry).side;
      return T * Eigen::Vector3d(half_m.array() * (down.array() < 0).select(-Eigen::Array3d::Ones(), 1.0));
    }
    case fcl::GEOM_SPHERE:
      return T.translation() - dynamic_cast<const fcl::Sphered&>(geometry).radius * normal;
    case fcl::GEOM_CAPSULE: {
      const auto& capsule = dynamic_cast<const fcl::Capsuled&>(geometry);
      const double end = down.z() < 0 ? -0.5 * capsule.lz : 0.5 * capsule.lz;
      return T * Eigen::Vector3d(0, 0, end) - capsule.radius * normal;
    }
    default: {
      const auto& mesh = dynamic_cast<const MeshModel&>(geometry);
      const auto* const lowest =
          std::max_element(mesh.vertices, mesh.vertices + mesh.num_vertices,
                           [&down](const auto& a, const auto& b) { return down.dot(a) < down.dot(b); });
      return T * *lowest;
    }
  }
}

}  // namespace

std::vector<Part> parts_of(const WorkcellBody& body, std::vector<Part> reuse) {
  std::vector<Part> parts;
  if (body.mesh != nullptr) {  // the first part of its body, in every frame
    parts.push_back(reuse.empty() ? part(*body.mesh) : std::move(reuse.front()));
  }
  const auto add = [&parts](const auto& shapes) {
    for (const auto& shape : shapes) {
      parts.push_back(part(shape));
    }
  };
  add(body.boxes);
  add(body.spheres);
  add(body.capsules);
  for (Part& p : parts) {
    p.object->setTransform(body.T_world_body * p.T_body_part);
    p.object->computeAABB();
    p.centre_world = body.T_world_body * p.centre_body;
  }
  return parts;
}

double least_distance_m(const Part& first, const Part& second) noexcept {
  return (first.centre_world - second.centre_world).norm() - first.radius_m - second.radius_m;
}

PartDistance distance(const Part& first, const Part& second) {
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  request.distance_tolerance = 1e-8;
  fcl::DistanceResultd result;
  const double distance_m = fcl::distance(first.object.get(), second.object.get(), request, result);
  return {std::max(0.0, distance_m), result.nearest_points[0], result.nearest_points[1]};
}

PartDistance distance(const Part& part, const Plane& plane_world) {
  const Eigen::Vector3d lowest = lowest_point(part, plane_world.normal);
  const double above_m = plane_world.normal.dot(lowest) - plane_world.offset_m;
  return {std::max(0.0, above_m), lowest, lowest - above_m * plane_world.normal};
}

}  // namespace depthgrid::workcell
