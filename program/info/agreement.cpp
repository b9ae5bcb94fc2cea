#include "program/info/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::program {

namespace {

constexpr double kConsistent_m = 0.05;
constexpr double kOtherSide_m = 0.1;
constexpr double kSameSurface_m = 0.3;
constexpr float kCosLargestAngle = 0.5F;  // 60 degrees
constexpr double kCoveredShare = 0.95;

}  // namespace

// NOLINTNEXTLINE(readability-function-cognitive-complexity): one pass whose order of tests splitting would hide
void add_pair(const Surface& a, const Surface& b, const PinholeCamera& camera_b, const Eigen::Isometry3d& T_b_a,
              double limit_m, int stride_px, const SensorMargin& margin_a, const SensorMargin& margin_b,
              PairAgreement& agreement) {
  const Eigen::Matrix3f rotation = T_b_a.linear().cast<float>();
  for (int v = 0; v < a.height_px; v += stride_px) {
    for (int u = 0; u < a.width_px; u += stride_px) {
      const std::size_t index_a =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(a.width_px) + static_cast<std::size_t>(u);
      const Eigen::Vector3d p_a = a.points[index_a].cast<double>();
      if (!(p_a.z() > 0.0 && p_a.z() <= limit_m)) {
        continue;
      }
      ++agreement.points;
      const Eigen::Vector3d p_b = T_b_a * p_a;
      if (!(p_b.z() > 0.0)) {
        continue;
      }
      const DepthPoint image = project(camera_b, p_b);
      if (!(image.x_px >= 0 && image.y_px >= 0 && image.x_px < camera_b.width_px && image.y_px < camera_b.height_px)) {
        continue;
      }
      const std::size_t index_b = static_cast<std::size_t>(image.y_px) * static_cast<std::size_t>(b.width_px) +
                                  static_cast<std::size_t>(image.x_px);
      const Eigen::Vector3d q_b = b.points[index_b].cast<double>();
      if (!(q_b.z() > 0.0)) {
        continue;
      }
      const double e_m = p_b.z() - q_b.z();
      ++agreement.pairs;
      agreement.consistent += std::abs(e_m) < kConsistent_m ? 1 : 0;
      agreement.in_front += e_m < -kOtherSide_m ? 1 : 0;
      agreement.behind += e_m > kOtherSide_m ? 1 : 0;
      agreement.along_ray_m.add(std::abs(e_m));

      const Eigen::Vector3f& normal_b = b.normals[index_b];
      if (!((rotation * a.normals[index_a]).dot(normal_b) > kCosLargestAngle)) {
        continue;
      }
      const double plane_m = normal_b.cast<double>().dot(p_b - q_b);  // positive: on the camera's side
      ++agreement.planes;
      agreement.near_plane += std::abs(plane_m) < kConsistent_m ? 1 : 0;
      agreement.to_plane_m.add(std::abs(plane_m));
      if (std::abs(plane_m) < kSameSurface_m) {
        // A margin moves a surface point along its viewing ray; what counts is how far that is along the normal.
        const Eigen::Vector3d n = normal_b.cast<double>();
        const double margins_m = depth_margin_m(margin_a, p_a.z()) * std::abs(n.dot(T_b_a.linear() * p_a)) / p_a.z() +
                                 depth_margin_m(margin_b, q_b.z()) * std::abs(n.dot(q_b)) / q_b.z();
        agreement.intrusion_m.add(std::max(0.0, plane_m - margins_m));
      }
    }
  }
}

double suggested_pose_margin_m(const PairAgreement& agreement) noexcept {
  return agreement.intrusion_m.quantile_m(kCoveredShare);
}

}  // namespace depthgrid::program
