#include "lab/peers/cloud_scan_peer.hpp"

#include <cmath>

#include "lab/peers/wide_scan.hpp"

namespace depthgrid::lab {

CloudScanPeer::CloudScanPeer(const PeerSetting& setting, Crop crop)
    : cell_(setting.cell), rho_m_(setting.rho_m), crop_(crop), deprojector_(setting.rig) {}

void CloudScanPeer::prepare(std::span<const Frame> frames, const Region& region) {
  x_.clear();
  y_.clear();
  z_.clear();
  const auto append = [this](float x, float y, float z) {
    x_.push_back(x);
    y_.push_back(y);
    z_.push_back(z);
  };
  deprojector_.run(frames, crop_box(crop_, cell_, region), append);
  while (x_.size() % kWidestVector != 0) {
    append(kFarAway, kFarAway, kFarAway);
  }
}

void CloudScanPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  const CloudColumns cloud{x_.data(), y_.data(), z_.data(), x_.size()};
  const auto bound = static_cast<float>(rho_m_ * rho_m_);
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    distances_m[i] = std::sqrt(nearest_squared(cloud, points_world[i].cast<float>(), bound));
  }
}

}  // namespace depthgrid::lab
