// A world of two dimensions, in which the definitions of docs/method.md can be drawn: solids, and cameras with one row
// of pixels. Metres.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace depthgrid::lab {

/// All points within `radius_m` of the segment.
struct FlatSolid {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = from;
  double radius_m = 0;
};

/// From the solid's surface; negative inside.
[[nodiscard]] double distance_m(const FlatSolid& solid, const Eigen::Vector2d& p);
/// To the nearest of them; infinite without any.
[[nodiscard]] double distance_m(std::span<const FlatSolid> solids, const Eigen::Vector2d& p);

struct FlatCamera {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< of length 1
  double half_angle_rad = 0.5;
  int pixels = 100;
  double near_m = 0.3;  ///< the end of the blind zone, along the axis as every depth
  double far_m = 4;     ///< what it reads where nothing is
};

/// What a camera has read, and what that makes known free: between near and the pixel's least reading within
/// `filter_px` pixels, less the margin; in a robot's pixels as far as the padded robot reaches.
class FlatView {
 public:
  FlatView(const FlatCamera& camera, std::span<const FlatSolid> solids, double margin_m = 0, int filter_px = 0,
           std::span<const FlatSolid> padded_robot = {});

  [[nodiscard]] bool looks_at(const Eigen::Vector2d& p) const;  ///< in the image and beyond near
  [[nodiscard]] bool frees(const Eigen::Vector2d& p) const;
  /// The whole ball around it.
  [[nodiscard]] bool frees(const Eigen::Vector2d& p, double radius_m) const;

  [[nodiscard]] const FlatCamera& camera() const { return camera_; }
  /// The place in pixels and the depth along the axis.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector2d& p) const;
  [[nodiscard]] Eigen::Vector2d deproject(double pixel, double depth_m) const;
  [[nodiscard]] double reading_m(int pixel) const { return read_m_[static_cast<std::size_t>(pixel)]; }
  [[nodiscard]] double free_m(int pixel) const { return free_m_[static_cast<std::size_t>(pixel)]; }

 private:
  FlatCamera camera_;
  std::vector<double> read_m_;
  std::vector<double> free_m_;  ///< g of docs/method.md
};

}  // namespace depthgrid::lab
