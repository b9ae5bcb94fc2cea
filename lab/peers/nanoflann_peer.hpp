// nanoflann: a k-d tree of the cloud, built anew for every frame set.
#pragma once

#include <memory>
#include <optional>

#include "lab/peers/cloud.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

struct NanoflannSettings {
  Crop crop = Crop::cell;
  std::size_t leaf = 10;  ///< nanoflann's default; larger leaves build faster
  double voxel_m = 0;     ///< keep one point a voxel; 0: all
};

class NanoflannPeer : public Peer {
 public:
  NanoflannPeer(const PeerSetting& setting, const NanoflannSettings& settings);
  ~NanoflannPeer() override;
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  struct Tree;
  Region cell_;
  double rho_m_;
  NanoflannSettings settings_;
  Deprojector deprojector_;
  std::optional<VoxelFilter> voxels_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace depthgrid::lab
