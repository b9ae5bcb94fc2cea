// The simulated cell as a bystander sees it: shaded surfaces, and gray where nobody knows.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/workcell.hpp"
#include "lab/workcell/depth_caster.hpp"
#include "report/canvas.hpp"

namespace depthgrid::experiments {

/// Which cubes of a box may hold something. World frame, metres.
struct UnknownCubes {
  Eigen::Vector3d low_world = Eigen::Vector3d::Zero();
  double side_m = 0.05;
  std::array<int, 3> count{};
  std::vector<std::uint8_t> unknown;  ///< x first; 1: may hold something

  UnknownCubes(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double side);
  [[nodiscard]] Eigen::Vector3d centre_world(std::size_t cube) const noexcept;
  /// False outside of the box.
  [[nodiscard]] bool contains_unknown(const Eigen::Vector3d& p_world) const noexcept;
};

/// One thread.
class CellView {
 public:
  /// From `eye_world` towards `target_world`, the vertical upright. Throws Error when the cell is invalid.
  CellView(const simulation::Workcell& cell, const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world,
           int width_px, int height_px);

  /// `haze`: cubes that are drawn as haze before what stands behind them. Throws Error when the bodies are others.
  [[nodiscard]] report::Raster draw(const simulation::Workcell& cell, const UnknownCubes& haze);

  /// Where a point is in the picture, in pixels.
  [[nodiscard]] report::CanvasPoint at(const Eigen::Vector3d& p_world) const noexcept;

 private:
  /// Share of a surface's colour that comes through the haze, along the ray of a pixel up to a depth.
  [[nodiscard]] double through(const UnknownCubes& haze, const Eigen::Vector3d& ray_world,
                               double depth_m) const noexcept;

  PinholeCamera camera_;
  Pose T_world_camera_;
  workcell::DepthCaster caster_;
  DepthImage depth_m_;
  workcell::BodyImage bodies_;
};

}  // namespace depthgrid::experiments
