#include "lab/peers/bubble_peer.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::lab {

BubblePeer::BubblePeer(const PeerSetting& setting) : rho_m_(setting.rho_m), people_world_(setting.people_world) {}

void BubblePeer::prepare(std::span<const Frame> frames, const Region& /*region*/) {
  bubbles_.clear();
  if (!people_world_ || frames.empty()) {
    return;
  }
  for (const Capsule& limb : people_world_(frames[0].time_s)) {
    // One a radius: the dents between two are an eighth of the radius deep.
    const int last = static_cast<int>(std::ceil((limb.b - limb.a).norm() / limb.radius_m));
    for (int i = 0; i <= last; ++i) {
      const double share = last > 0 ? static_cast<double>(i) / last : 0;
      bubbles_.push_back(Capsule::sphere(limb.a + share * (limb.b - limb.a), limb.radius_m));
    }
  }
}

void BubblePeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    distances_m[i] = rho_m_;
    for (const Capsule& bubble : bubbles_) {
      distances_m[i] = std::min(distances_m[i], std::max(0.0, (points_world[i] - bubble.a).norm() - bubble.radius_m));
    }
  }
}

}  // namespace depthgrid::lab
