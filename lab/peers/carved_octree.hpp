// OctoMap with free space carved along every ray, as both of its peers use it.
#pragma once

#include <octomap/octomap.h>

#include <cstdint>
#include <vector>

#include "lab/peers/masked_image.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

enum class History : std::uint8_t {
  kept,   ///< one map for all frame sets, as OctoMap is meant
  fresh,  ///< an empty map for every frame set: nothing lags behind what moves
};

/// Rays are inserted with one end a voxel and inner nodes brought up to date once (`discretize`, `lazy_eval`: six times
/// faster than without). Rays to the robot carve up to the robot's exit and occupy nothing. No bounding box is set:
/// OctoMap carves nothing along rays that end outside it.
class CarvedOctree {
 public:
  CarvedOctree(const Rig& rig, double resolution_m, History history);
  void insert(std::span<const Frame> frames);
  [[nodiscard]] octomap::OcTree& tree() { return tree_; }

 private:
  struct Camera {
    RigCamera source;
    DepthImage depth_m;  ///< 0 where the robot is
    DepthImage exit_m;   ///< like depth_m, the robot's exit where it is
  };
  [[nodiscard]] octomap::point3d to_world(const RigCamera& camera, int u, int v, float depth_m) const;

  octomap::OcTree tree_;
  History history_;
  std::vector<Camera> cameras_;
};

}  // namespace depthgrid::lab
