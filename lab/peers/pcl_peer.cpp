#include "lab/peers/pcl_peer.hpp"

#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>

namespace depthgrid::lab {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

struct PclPeer::State {
  Cloud::Ptr cloud{new Cloud};
  Cloud::Ptr thinned{new Cloud};
  pcl::VoxelGrid<pcl::PointXYZ> voxels;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  pcl::Indices indices = pcl::Indices(1);
  std::vector<float> squared = std::vector<float>(1);
  bool empty = true;
};

PclPeer::PclPeer(const PeerSetting& setting, const PclSettings& settings)
    : cell_(setting.cell),
      rho_m_(setting.rho_m),
      settings_(settings),
      deprojector_(setting.rig),
      state_(std::make_unique<State>()) {}

PclPeer::~PclPeer() = default;

void PclPeer::prepare(std::span<const Frame> frames, const Region& region) {
  Cloud& cloud = *state_->cloud;
  cloud.clear();
  deprojector_.run(frames, crop_box(settings_.crop, cell_, region),
                   [&cloud](float x, float y, float z) { cloud.points.emplace_back(x, y, z); });
  cloud.width = static_cast<std::uint32_t>(cloud.points.size());
  cloud.height = 1;
  Cloud::Ptr source = state_->cloud;
  if (settings_.voxel_m > 0) {
    const auto side = static_cast<float>(settings_.voxel_m);
    state_->voxels.setLeafSize(side, side, side);
    state_->voxels.setInputCloud(state_->cloud);
    state_->voxels.filter(*state_->thinned);
    source = state_->thinned;
  }
  state_->empty = source->empty();
  if (!state_->empty) {
    state_->tree.setInputCloud(source);
  }
}

void PclPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    const Eigen::Vector3f p = points_world[i].cast<float>();
    const bool found = !state_->empty && state_->tree.nearestKSearch(pcl::PointXYZ(p.x(), p.y(), p.z()), 1,
                                                                     state_->indices, state_->squared) > 0;
    distances_m[i] = found ? std::min<double>(rho_m_, std::sqrt(state_->squared[0])) : rho_m_;
  }
}

}  // namespace depthgrid::lab
