// How much of the empty workspace no camera has seen free.
#pragma once

#include <cstddef>

#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/stage/camera_images.hpp"
#include "lab/experiments/stage/staged_cell.hpp"

namespace depthgrid::experiments {

/// Counts of sample points in the workspace that lie in no body.
struct GrayArea {
  std::size_t empty = 0;
  std::size_t gray = 0;        ///< of these, seen free by no camera
  std::size_t empty_near = 0;  ///< within rho (DistanceMethod::kRho) of a control point of the arm
  std::size_t gray_near = 0;

  void add(const GrayArea& other) noexcept;
  [[nodiscard]] double share() const noexcept;
  [[nodiscard]] double share_near() const noexcept;
};

/// With the images and margins of all cameras, at points `spacing_m` apart. Throws Error unless it is positive.
[[nodiscard]] GrayArea gray_area(const StagedCell& stage, const CameraImages& images,
                                 const simulation::Arrangement& arrangement, double spacing_m);

}  // namespace depthgrid::experiments
