#include "lab/peers/fcl_peer.hpp"

#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>

namespace depthgrid::lab {

constexpr double kSphereRadius = 1e-3;  ///< a point has no shape in FCL; taken off the distance again

struct FclPeer::Objects {
  explicit Objects(octomap::OcTree& tree)
      // FCL wants to share the tree; the map keeps it.
      : octree(std::make_shared<fcl::OcTree<double>>(
            std::shared_ptr<const octomap::OcTree>(&tree, [](const octomap::OcTree*) {}))),
        sphere(std::make_shared<fcl::Sphere<double>>(kSphereRadius)),
        octree_object(octree),
        sphere_object(sphere) {}

  std::shared_ptr<fcl::OcTree<double>> octree;
  std::shared_ptr<fcl::Sphere<double>> sphere;
  fcl::CollisionObject<double> octree_object;
  fcl::CollisionObject<double> sphere_object;
};

FclPeer::FclPeer(const PeerSetting& setting, double resolution_m)
    : rho_m_(setting.rho_m), map_(setting.rig, resolution_m, History::kept) {}

FclPeer::~FclPeer() = default;

void FclPeer::prepare(std::span<const Frame> frames, const Region& /*region*/) {
  map_.insert(frames);
  objects_ = std::make_unique<Objects>(map_.tree());
}

void FclPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    objects_->sphere_object.setTranslation(points_world[i]);
    objects_->sphere_object.computeAABB();
    fcl::DistanceResult<double> result;
    const double distance_m =
        fcl::distance(&objects_->sphere_object, &objects_->octree_object, fcl::DistanceRequest<double>(), result);
    distances_m[i] = distance_m > 0 ? std::min(distance_m + kSphereRadius, rho_m_) : 0.0;
  }
}

}  // namespace depthgrid::lab
