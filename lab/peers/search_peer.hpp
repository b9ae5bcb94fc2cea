// Ours: the sound search.
#pragma once

#include <vector>

#include "depthgrid/search/search.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::bench {

/// W is the cell, unobserved space and pockets behind the robot are obstacles, outside is ignored; the margins are
/// those of the setting.
[[nodiscard]] search::Settings search_settings(const PeerSetting& setting, double resolution_m);

class SearchPeer : public Peer {
 public:
  SearchPeer(const PeerSetting& setting, double resolution_m);
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

  [[nodiscard]] search::ViewStore& store() { return store_; }
  [[nodiscard]] const search::Snapshot& snapshot() const { return snapshot_; }
  [[nodiscard]] search::Search& search() { return search_; }

 private:
  double rho_m_;
  search::ViewStore store_;
  search::Snapshot snapshot_;
  search::Search search_;
  std::vector<search::Primitive> primitives_;
  std::vector<search::Answer> answers_;
};

}  // namespace depthgrid::bench
