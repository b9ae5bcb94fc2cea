#include "lab/peers/nanoflann_peer.hpp"

#include <array>
#include <cmath>
#include <nanoflann.hpp>

namespace depthgrid::lab {
namespace {

struct Points {
  std::vector<std::array<float, 3>> xyz;

  // The names that nanoflann asks for.
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return xyz.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t index, std::size_t axis) const { return xyz[index][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3>;

}  // namespace

struct NanoflannPeer::Tree {
  Points points;
  std::unique_ptr<Index> index;
};

NanoflannPeer::NanoflannPeer(const PeerSetting& setting, const NanoflannSettings& settings)
    : cell_(setting.cell),
      rho_m_(setting.rho_m),
      settings_(settings),
      deprojector_(setting.rig),
      tree_(std::make_unique<Tree>()) {
  if (settings.voxel_m > 0) {
    voxels_.emplace(setting.cell, settings.voxel_m);
  }
}

NanoflannPeer::~NanoflannPeer() = default;

void NanoflannPeer::prepare(std::span<const Frame> frames, const Region& region) {
  std::vector<std::array<float, 3>>& xyz = tree_->points.xyz;
  xyz.clear();
  if (voxels_) {
    voxels_->clear();
    deprojector_.run(frames, crop_box(settings_.crop, cell_, region), [&](float x, float y, float z) {
      if (voxels_->first(x, y, z)) {
        xyz.push_back({x, y, z});
      }
    });
  } else {
    deprojector_.run(frames, crop_box(settings_.crop, cell_, region), [&](float x, float y, float z) {
      xyz.push_back({x, y, z});
    });
  }
  // The constructor builds the tree.
  tree_->index = std::make_unique<Index>(3, tree_->points, nanoflann::KDTreeSingleIndexAdaptorParams(settings_.leaf));
}

void NanoflannPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    const Eigen::Vector3f p = points_world[i].cast<float>();
    std::uint32_t nearest = 0;
    float squared = 0;
    nanoflann::KNNResultSet<float, std::uint32_t> result(1);
    result.init(&nearest, &squared);
    squared = static_cast<float>(rho_m_ * rho_m_);  // stops the search at rho: nothing nearer than the first bound
    if (!tree_->points.xyz.empty()) {
      tree_->index->findNeighbors(result, p.data(), nanoflann::SearchParams());
    }
    distances_m[i] = std::sqrt(squared);
  }
}

}  // namespace depthgrid::lab
