#include "lab/peers/search_peer.hpp"

#include <algorithm>

namespace depthgrid::lab {

views::Settings search_settings(const PeerSetting& setting, double resolution_m) {
  views::Settings settings;
  settings.space = views::BoxSpace{setting.cell.low_world, setting.cell.high_world};
  settings.policies.unobserved = views::Policy::obstacle;
  settings.policies.outside = views::Policy::ignored;
  settings.policies.robot_pockets = views::Policy::obstacle;
  CameraMargins margins;
  margins.sensor = setting.sensor;
  margins.translation_m = setting.pose.translation_m;
  margins.rotation_rad = setting.pose.rotation_rad;
  margins.smallest_obstacle_m = 0;
  settings.margins.assign(setting.rig.cameras.size(), margins);
  settings.rho_m = setting.rho_m;
  settings.resolution_m = resolution_m;
  settings.v_max_m_s = 0;
  return settings;
}

SearchPeer::SearchPeer(const PeerSetting& setting, double resolution_m)
    : rho_m_(setting.rho_m),
      store_(setting.rig, search_settings(setting, resolution_m)),
      snapshot_(store_.snapshot()) {}

void SearchPeer::prepare(std::span<const Frame> frames, const Region& /*region*/) {
  for (std::size_t k = 0; k < frames.size(); ++k) {
    (void)store_.update(k, frames[k]);
  }
  snapshot_ = store_.snapshot();
}

void SearchPeer::renew(std::size_t camera, const Frame& frame) {
  (void)store_.update(camera, frame);
  snapshot_ = store_.snapshot();
}

void SearchPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  primitives_.resize(points_world.size());
  answers_.resize(points_world.size());
  std::transform(points_world.begin(), points_world.end(), primitives_.begin(), Capsule::point);
  search_.distances(snapshot_, primitives_, answers_);
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    distances_m[i] = has_distance(answers_[i].nearest) ? answers_[i].nearest.distance_m : rho_m_;
  }
}

}  // namespace depthgrid::lab
