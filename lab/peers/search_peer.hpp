// Ours: the sound search.
#pragma once

#include <vector>

#include "depthgrid/search/search.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

/// W is the cell, unobserved space and pockets behind the robot are obstacles, outside is ignored; the margins are
/// those of the setting.
[[nodiscard]] views::Settings search_settings(const PeerSetting& setting, double resolution_m);

class SearchPeer : public Peer {
 public:
  SearchPeer(const PeerSetting& setting, double resolution_m);
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

  /// One camera's image and a snapshot with it.
  void renew(std::size_t camera, const Frame& frame);

  [[nodiscard]] views::ViewStore& store() { return store_; }
  [[nodiscard]] const views::Snapshot& snapshot() const { return snapshot_; }
  [[nodiscard]] search::Search& search() { return search_; }

 private:
  double rho_m_;
  views::ViewStore store_;
  views::Snapshot snapshot_;
  search::Search search_;
  std::vector<Capsule> primitives_;
  std::vector<Answer> answers_;
};

}  // namespace depthgrid::lab
