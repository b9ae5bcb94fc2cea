// OctoMap with dynamicEDT3D: an exact distance transform of the map, looked up by voxel.
#pragma once

#include <memory>

#include "lab/peers/carved_octree.hpp"

namespace depthgrid::lab {

struct EdtSettings {
  double resolution_m = 0.05;
  History history = History::kept;
  bool unknown_is_occupied = false;
};

class EdtPeer : public Peer {
 public:
  EdtPeer(const PeerSetting& setting, const EdtSettings& settings);
  ~EdtPeer() override;
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  struct Transform;
  double rho_m_;
  EdtSettings settings_;
  CarvedOctree map_;
  std::unique_ptr<Transform> transform_;
};

}  // namespace depthgrid::lab
