// Distance evaluation on the depth grid: the letter's section VI, literally or with its errors mended.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/proximity.hpp"
#include "depthgrid/core/repulsion_law.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/depth_grid_map.hpp"

namespace depthgrid::grid {

enum class Variant : std::uint8_t {
  letter,     ///< what is printed, errors included
  corrected,  ///< never over-estimates the distance to what no camera has seen free
};

/// Which pixels of the principal camera are evaluated.
enum class Window : std::uint8_t {
  region_of_surveillance,  ///< equations (8)-(9) in `letter`, the exact window of the rho-sphere in `corrected`
  whole_image,
};

/// What is collected.
enum class Collect : std::uint8_t {
  minimum,  ///< the nearest obstacle only, by the scan that shrinks with the best distance so far
  hybrid,   ///< equation (11): distance of the nearest, direction from all obstacles within rho
};

/// Space outside the grid (the principal camera's frustum between d_min and d_max).
enum class OutsideSpace : std::uint8_t {
  ignored,   ///< obstacles outside are not reported; a point outside has no distance (state outside)
  obstacle,  ///< it counts as obstacle: D = min(D, distance to the border), 0 for a point outside
};

struct EvaluationSettings {
  Variant variant = Variant::corrected;
  Window window = Window::region_of_surveillance;
  Collect collect = Collect::minimum;
  OutsideSpace outside = OutsideSpace::ignored;
  double rho_m = kDefaultRho;  ///< surveillance radius
  SensorMargin sensor;         ///< corrected only; one for all cameras: take the worst
  PoseMargin pose;             ///< corrected only; one for all cameras: take the worst
  double direction_blend =
      kDefaultBlend;  ///< b in [0, 1]: weight of the other obstacles in corrected's hybrid direction
  double repulsion_alpha = kDefaultAlpha;  ///< shape of the repulsion that weights them
  double max_frame_age_s =
      1e9;  ///< a frame older than the newest by more than this, or without a
            ///< finite time, makes answers stale; all cameras frozen together is for the caller to see
};

/// Throws Error with value and rule.
void validate(const EvaluationSettings& settings);

/// One control point's answer.
struct Evaluation {
  Proximity nearest;
  /// Equation (11) in `letter`: the mean of the unit vectors from the point to each obstacle point within rho, not
  /// normalised, as printed. In `corrected`: unit vector led by the nearest direction. Zero when there is none.
  Eigen::Vector3d hybrid_direction_world = Eigen::Vector3d::Zero();
  std::int64_t obstacle_points = 0;  ///< N of (11): principal pixels with an obstacle within rho (hybrid only)
};

/// Work done, for figures.
struct EvaluationCount {
  std::int64_t pixels = 0;       ///< principal pixels visited
  std::int64_t cells = 0;        ///< cells checked with the secondary cameras
  std::int64_t gray_pixels = 0;  ///< pixels in case (iii) or (iv): their distance depends on the other cameras
};

/// Evaluates distances on one rig. update() and evaluate() do not allocate, lock or throw. evaluate() may be called
/// from many threads at once, but not while update() runs.
class GridEvaluator {
 public:
  /// `principal` indexes rig.cameras; all other cameras are secondary. Images must be free of lens distortion already.
  /// Throws Error when rig, grid or settings are invalid, or when `map` was made for another calibration.
  GridEvaluator(const Rig& rig, std::size_t principal, const DepthQuantisation& quantisation,
                const EvaluationSettings& settings, std::shared_ptr<const DepthGridMap> map = nullptr);
  ~GridEvaluator();
  GridEvaluator(GridEvaluator&&) noexcept;
  GridEvaluator& operator=(GridEvaluator&&) noexcept;
  GridEvaluator(const GridEvaluator&) = delete;
  GridEvaluator& operator=(const GridEvaluator&) = delete;

  /// Takes the newest frame of every camera, in the rig's order. A camera whose frame is missing (no data), has another
  /// size or depth scale than the rig says, or half a robot view counts as "no measurement" everywhere; false when
  /// there was one.
  bool update(std::span<const Frame> frames) noexcept;

  /// Distance of one control point in the world frame (metres). A non-finite point gives not_evaluated.
  [[nodiscard]] Evaluation evaluate(const Eigen::Vector3d& p_world, EvaluationCount* count = nullptr) const noexcept;

  /// Many control points; answers.size() should equal points_world.size(): answers without a point are not_evaluated.
  /// `count` must not be shared between threads.
  void evaluate(std::span<const Eigen::Vector3d> points_world, std::span<Evaluation> answers,
                EvaluationCount* count = nullptr) const noexcept;

  [[nodiscard]] const DepthGrid& grid() const noexcept;
  [[nodiscard]] const EvaluationSettings& settings() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::grid
