#include "lab/peers/edt_peer.hpp"

#include <dynamicEDT3D/dynamicEDTOctomap.h>

#include <algorithm>

namespace depthgrid::lab {

namespace {

octomap::point3d to_octomap(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

struct EdtPeer::Transform {
  Transform(octomap::OcTree& tree, const Region& box, double rho_m, bool unknown_is_occupied)
      : region(box),
        distances(static_cast<float>(rho_m), &tree, to_octomap(box.low_world), to_octomap(box.high_world),
                  unknown_is_occupied) {}

  Region region;
  DynamicEDTOctomap distances;
};

EdtPeer::EdtPeer(const PeerSetting& setting, const EdtSettings& settings)
    : rho_m_(setting.rho_m), settings_(settings), map_(setting.rig, settings.resolution_m, settings.history) {}

EdtPeer::~EdtPeer() = default;

void EdtPeer::prepare(std::span<const Frame> frames, const Region& region) {
  map_.insert(frames);
  // Kept between frame sets it follows the changes of the map, which is what makes it dynamic.
  const bool reusable = settings_.history == History::kept && transform_ != nullptr &&
                        transform_->region.low_world == region.low_world &&
                        transform_->region.high_world == region.high_world;
  if (!reusable) {
    transform_ = std::make_unique<Transform>(map_.tree(), region, rho_m_, settings_.unknown_is_occupied);
  }
  transform_->distances.update();
}

void EdtPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    const float distance_m = transform_->distances.getDistance(to_octomap(points_world[i]));
    distances_m[i] = distance_m >= 0 ? std::min<double>(distance_m, rho_m_) : rho_m_;
  }
}

}  // namespace depthgrid::lab
