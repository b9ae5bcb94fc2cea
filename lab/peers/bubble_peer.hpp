// A tracker's model of people: bubbles along the limbs, from where the people really are. Its best case: no error of
// tracking, no delay. Nothing but people is an obstacle, and the images are not looked at.
#pragma once

#include <vector>

#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

class BubblePeer : public Peer {
 public:
  explicit BubblePeer(const PeerSetting& setting);
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  double rho_m_;
  std::function<std::vector<Capsule>(double time_s)> people_world_;
  std::vector<Capsule> bubbles_;
};

}  // namespace depthgrid::lab
