// The grid evaluators of this project: `letter` and `corrected`.
#pragma once

#include <vector>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

class GridPeer : public Peer {
 public:
  GridPeer(const PeerSetting& setting, grid::Variant variant, grid::Collect collect);
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  double rho_m_;
  grid::GridEvaluator evaluator_;
  std::vector<Capsule> points_;
  std::vector<Answer> answers_;
};

}  // namespace depthgrid::lab
