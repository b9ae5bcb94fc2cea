// All pixels that may show something within rho, as the literature scans a depth image: what a pixel's ray crosses from
// the measured depth on counts as obstacle.
#pragma once

#include <cstdint>
#include <vector>

#include "lab/peers/masked_image.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

class WindowScanPeer : public Peer {
 public:
  /// How the cameras' distances become one.
  enum class Combine : std::uint8_t {
    first,    ///< the first camera alone
    minimum,  ///< the usual choice: no shadow is ever carved
    maximum,  ///< a lower bound of the distance to what no camera sees free
  };
  WindowScanPeer(const PeerSetting& setting, Combine combine);
  void prepare(std::span<const Frame> frames, const Region& region) override;
  void query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) override;

 private:
  struct Camera {
    RigCamera source;
    Pose T_camera_world;
    DepthImage free_m;
    std::vector<float> slope_x, slope_y;
  };
  [[nodiscard]] double one_camera_m(const Camera& camera, const Eigen::Vector3d& p_world) const;

  double rho_m_;
  Combine combine_;
  std::vector<Camera> cameras_;
};

}  // namespace depthgrid::lab
