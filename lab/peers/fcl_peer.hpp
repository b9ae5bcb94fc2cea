// FCL: the distance from a sphere to the occupied voxels of the octree.
#pragma once

#include <memory>

#include "lab/peers/carved_octree.hpp"

namespace depthgrid::lab {

class FclPeer : public Peer {
 public:
  FclPeer(const PeerSetting& setting, double resolution_m);
  ~FclPeer() override;
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  struct Objects;
  double rho_m_;
  CarvedOctree map_;
  std::unique_ptr<Objects> objects_;
};

}  // namespace depthgrid::lab
