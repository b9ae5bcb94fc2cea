// The whole cloud, point by point, with vector instructions.
#pragma once

#include <vector>

#include "lab/peers/cloud.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

class CloudScanPeer : public Peer {
 public:
  CloudScanPeer(const PeerSetting& setting, Crop crop);
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  Region cell_;
  double rho_m_;
  Crop crop_;
  Deprojector deprojector_;
  std::vector<float> x_, y_, z_;
};

}  // namespace depthgrid::lab
