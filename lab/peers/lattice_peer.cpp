#include "lab/peers/lattice_peer.hpp"

#include <algorithm>

#include "lab/peers/masked_image.hpp"

namespace depthgrid::lab {

LatticePeer::LatticePeer(const PeerSetting& setting, double pitch_m)
    : cell_(setting.cell), rho_m_(setting.rho_m), rig_(setting.rig) {
  const int reach = static_cast<int>(rho_m_ / pitch_m);
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      for (int k = -reach; k <= reach; ++k) {
        const Eigen::Vector3f offset = Eigen::Vector3i(i, j, k).cast<float>() * static_cast<float>(pitch_m);
        if (offset.norm() < static_cast<float>(rho_m_)) {
          offsets_.push_back(offset);
        }
      }
    }
  }
  std::sort(offsets_.begin(), offsets_.end(),
            [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a.squaredNorm() < b.squaredNorm(); });
  for (const RigCamera& source : rig_.cameras) {
    const PinholeCamera& c = source.intrinsics;
    Eigen::Matrix3d K;
    K << c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1;
    projection_.push_back((K * source.T_world_camera.inverse().matrix().topRows<3>()).cast<float>());
    free_m_.emplace_back(c.width_px, c.height_px);
  }
}

void LatticePeer::prepare(std::span<const Frame> frames, const Region& /*region*/) {
  for (std::size_t k = 0; k < free_m_.size(); ++k) {
    robot_looked_through(frames[k], rig_.cameras[k].rule, free_m_[k]);
  }
}

bool LatticePeer::seen_free(const Eigen::Vector3f& x_world) const {
  for (std::size_t k = 0; k < free_m_.size(); ++k) {
    const Eigen::Vector3f q = projection_[k] * x_world.homogeneous();
    const float u = q.x() / q.z();
    const float v = q.y() / q.z();
    const DepthImage& image = free_m_[k];
    if (q.z() > 0 && u >= 0 && v >= 0 && u < static_cast<float>(image.width_px()) &&
        v < static_cast<float>(image.height_px()) && q.z() < image.at(static_cast<int>(u), static_cast<int>(v))) {
      return true;
    }
  }
  return false;
}

void LatticePeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    distances_m[i] = rho_m_;
    for (const Eigen::Vector3f& offset : offsets_) {
      const Eigen::Vector3f x_world = points_world[i].cast<float>() + offset;
      if (cell_.contains(x_world.cast<double>()) && !seen_free(x_world)) {
        distances_m[i] = offset.norm();
        break;
      }
    }
  }
}

}  // namespace depthgrid::lab
