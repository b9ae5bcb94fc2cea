// Distances by the letter's grid.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/avoidance/distance_source.hpp"
#include "depthgrid/grid/evaluation.hpp"

namespace depthgrid::avoidance {

/// What becomes of the robot's own pixels.
enum class RobotPixels : std::uint8_t {
  case_iv,  ///< the letter's case (iv): what is behind the robot is asked of the other cameras, and an obstacle without
  removed,  ///< taken out of the image, as the letter does with a single camera: nothing behind the robot is seen
};

struct GridDistancesSettings {
  std::size_t principal = 0;  ///< index in the rig
  grid::DepthQuantisation cells;
  grid::EvaluationSettings evaluation;  ///< Collect::hybrid for a controller
  RobotPixels robot_pixels = RobotPixels::case_iv;
};

/// The distance of a part is that of its first end, as a point: the letter knows neither capsules nor radii, and does
/// not ask how old an image is.
class GridDistances final : public DistanceSource {
 public:
  /// Throws Error as GridEvaluator does.
  GridDistances(const Rig& rig, const GridDistancesSettings& settings);

  [[nodiscard]] std::string_view name() const noexcept override { return "grid"; }
  bool take(std::span<const Frame> frames) noexcept override;
  void evaluate(std::span<const Capsule> parts_world, double now_s, std::span<PartAnswer> answers) noexcept override;

 private:
  [[nodiscard]] Frame without_robot(std::size_t camera, const Frame& frame) noexcept;

  Rig rig_;
  RobotPixels robot_pixels_;
  double beyond_m_;  ///< deeper than the grid
  grid::GridEvaluator evaluator_;
  std::vector<DepthImage> depth_m_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::avoidance
