// What the benchmark compares: anything that takes the frames of all cameras and answers distances from points.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::lab {

/// A box with axes along the world's, metres.
struct Region {
  Eigen::Vector3d low_world;
  Eigen::Vector3d high_world;

  [[nodiscard]] bool contains(const Eigen::Vector3d& p_world) const {
    return (p_world.array() >= low_world.array()).all() && (p_world.array() <= high_world.array()).all();
  }
};

/// What every peer is told once.
struct PeerSetting {
  Rig rig;
  Region cell;          ///< the space of interest
  double rho_m = 0.4;   ///< distances beyond it need not be found
  SensorMargin sensor;  ///< only peers that know margins use them
  PoseMargin pose;
  /// Where the people really are at a frame's time, world frame: for those that stand on a tracker, at its best.
  std::function<std::vector<Capsule>(double time_s)> people_world;
};

/// Robot pixels, those whose depth lies in the robot's interval, are no obstacle to any peer. Not thread-safe.
class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  /// Takes a new frame set, one frame a camera in the rig's order. Points asked about until the next call lie in
  /// `region` less rho on every side; peers that build a structure may limit it to that.
  virtual void prepare(std::span<const Frame> frames, const Region& region) = 0;

  /// Distance from each point (world frame) in metres, rho where nothing is nearer.
  virtual void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) = 0;
};

/// A peer's row in the tables.
struct PeerKind {
  std::string name;
  std::string family;            ///< peers that differ in one setting only
  bool counts_occluded = false;  ///< space that no camera sees counts as obstacle
  bool carves = false;           ///< another camera can free what one camera cannot see
  int most_cameras = 8;          ///< not run with more: it would take minutes
  std::function<std::unique_ptr<Peer>(const PeerSetting&)> make;
};

/// Peers that need nothing but this project: `letter`, `corrected`, ours, and what a good engineer writes in an
/// afternoon.
[[nodiscard]] std::vector<PeerKind> own_peers();

/// Peers from other people's libraries; empty unless built with DEPTHGRID_BUILD_PEERS.
[[nodiscard]] std::vector<PeerKind> foreign_peers();

}  // namespace depthgrid::lab
