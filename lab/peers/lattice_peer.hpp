// What a good engineer writes in an afternoon: a lattice of points around the control point, nearest first, each tested
// against every camera until one is found that no camera sees free.
#pragma once

#include <vector>

#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

class LatticePeer : public Peer {
 public:
  LatticePeer(const PeerSetting& setting, double pitch_m);
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  [[nodiscard]] bool seen_free(const Eigen::Vector3f& x_world) const;

  Region cell_;
  double rho_m_;
  Rig rig_;
  std::vector<Eigen::Vector3f> offsets_;  ///< in order of distance
  std::vector<Eigen::Matrix<float, 3, 4>> projection_;
  std::vector<DepthImage> free_m_;
};

}  // namespace depthgrid::lab
