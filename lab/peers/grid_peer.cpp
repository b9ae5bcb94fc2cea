#include "lab/peers/grid_peer.hpp"

#include <algorithm>

namespace depthgrid::lab {
namespace {

grid::EvaluationSettings evaluation_settings(const PeerSetting& setting, grid::Variant variant, grid::Collect collect) {
  grid::EvaluationSettings settings;
  settings.variant = variant;
  settings.collect = collect;
  settings.rho_m = setting.rho_m;
  settings.sensor = setting.sensor;
  settings.pose = setting.pose;
  return settings;
}

}  // namespace

GridPeer::GridPeer(const PeerSetting& setting, grid::Variant variant, grid::Collect collect)
    : rho_m_(setting.rho_m),
      evaluator_(setting.rig, 0, {0.2882, 0.01, 0.0, 343}, evaluation_settings(setting, variant, collect)) {}

void GridPeer::prepare(std::span<const Frame> frames, const Region& /*region*/) {
  (void)update_all(evaluator_, frames);
}

void GridPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  points_.resize(points_world.size());
  answers_.resize(points_world.size());
  std::transform(points_world.begin(), points_world.end(), points_.begin(), Capsule::point);
  evaluator_.evaluate(points_, 0, answers_);
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    distances_m[i] = has_distance(answers_[i].nearest) ? answers_[i].nearest.distance_m : rho_m_;
  }
}

}  // namespace depthgrid::lab
