// PCL's KdTreeFLANN on the cloud, with or without its VoxelGrid before it.
#pragma once

#include <memory>

#include "lab/peers/cloud.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

struct PclSettings {
  Crop crop = Crop::cell;
  double voxel_m = 0;  ///< side of VoxelGrid's leaves; 0: no VoxelGrid
};

class PclPeer : public Peer {
 public:
  PclPeer(const PeerSetting& setting, const PclSettings& settings);
  ~PclPeer() override;
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  struct State;
  Region cell_;
  double rho_m_;
  PclSettings settings_;
  Deprojector deprojector_;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::lab
