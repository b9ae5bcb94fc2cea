#include "lab/peers/carved_octree.hpp"

namespace depthgrid::lab {

constexpr double kLongestRay = 4.0;  ///< covers the cell from every camera

CarvedOctree::CarvedOctree(const Rig& rig, double resolution_m, History history)
    : tree_(resolution_m), history_(history) {
  for (const RigCamera& source : rig.cameras) {
    const DepthImage image(source.intrinsics.width_px, source.intrinsics.height_px);
    cameras_.push_back({source, image, image});
  }
}

octomap::point3d CarvedOctree::to_world(const RigCamera& camera, int u, int v, float depth_m) const {
  const Eigen::Vector3f p =
      (camera.T_world_camera * deproject(camera.intrinsics, {u + 0.5, v + 0.5, depth_m})).cast<float>();
  return {p.x(), p.y(), p.z()};
}

void CarvedOctree::insert(std::span<const Frame> frames) {
  if (history_ == History::fresh) {
    tree_.clear();
    tree_.enableChangeDetection(false);  // a transform of the map before has switched it on
    tree_.resetChangeDetection();
  }
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    Camera& camera = cameras_[k];
    robot_removed(frames[k], camera.source.rule, camera.depth_m);
    robot_looked_through(frames[k], camera.source.rule, camera.exit_m);
    octomap::Pointcloud surfaces;
    octomap::Pointcloud exits;
    for (int v = 0; v < camera.depth_m.height_px(); ++v) {
      for (int u = 0; u < camera.depth_m.width_px(); ++u) {
        const float depth_m = camera.exit_m.at(u, v);
        if (depth_m > 0) {
          (camera.depth_m.at(u, v) > 0 ? surfaces : exits).push_back(to_world(camera.source, u, v, depth_m));
        }
      }
    }
    const Eigen::Vector3f centre = camera.source.T_world_camera.translation().cast<float>();
    const octomap::point3d origin(centre.x(), centre.y(), centre.z());
    octomap::KeySet free;
    octomap::KeySet occupied;
    tree_.computeDiscreteUpdate(surfaces, origin, free, occupied, kLongestRay);
    octomap::KeySet ignored;
    tree_.computeDiscreteUpdate(exits, origin, free, ignored, kLongestRay);
    for (const octomap::OcTreeKey& key : free) {
      if (occupied.find(key) == occupied.end()) {
        tree_.updateNode(key, false, true);
      }
    }
    for (const octomap::OcTreeKey& key : occupied) {
      tree_.updateNode(key, true, true);
    }
  }
  tree_.updateInnerOccupancy();
}

}  // namespace depthgrid::lab
