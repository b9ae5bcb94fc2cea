// The cloud as convex objects: PCL's planes and clusters, the hull of each by Qhull, and FCL's distance to them.
#pragma once

#include <memory>

#include "lab/peers/cloud.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

class HullPeer : public Peer {
 public:
  /// The cloud is thinned to a point a voxel.
  HullPeer(const PeerSetting& setting, double voxel_m);
  ~HullPeer() override;
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  struct State;
  Region cell_;
  double rho_m_;
  Deprojector deprojector_;
  VoxelFilter voxels_;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::lab
