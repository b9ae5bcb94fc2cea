// What more cameras cost and what they give: time of an evaluation, gray area, pockets behind the robot.
#pragma once

#include <string>
#include <vector>

#include "lab/experiments/cameras/gray_area.hpp"
#include "lab/experiments/experiment.hpp"
#include "lab/experiments/stage/deviation_table.hpp"

namespace depthgrid::experiments {

/// One method with one number of cameras.
struct CountedMethod {
  std::string label;
  double evaluation_s = 0;  ///< processor time for nine points, median
  double update_s = 0;      ///< processor time to prepare the images of one instant, median
  Deviation deviation;      ///< of the nine control points
  /// Points of the arm's surface, grown by the padding, that are farther than kFar from everything, and those of them
  /// that read less than kTouching; letter and search only.
  std::size_t far = 0;
  std::size_t pockets = 0;
};

// Places in CameraCount::methods.
inline constexpr std::size_t kCountedHybrid = 0;  ///< letter, hybrid
inline constexpr std::size_t kCountedLetter = 1;
inline constexpr std::size_t kCountedCorrected = 2;
inline constexpr std::size_t kCountedSearch = 3;
inline constexpr std::size_t kCountedMemory = 4;  ///< where a sensor is given

struct CameraCount {
  int cameras = 0;
  GrayArea gray;
  std::vector<CountedMethod> methods;
};

inline constexpr double kFar = 0.10;       ///< metres
inline constexpr double kTouching = 0.01;  ///< metres

/// time = offset + slope * cameras by least squares, from two cameras on: with one the scan of the grid ends early.
struct LinearFit {
  double offset_s = 0;
  double slope_s = 0;
  double r_squared = 0;
};
[[nodiscard]] LinearFit linear_fit(const std::vector<CameraCount>& counts, std::size_t method);

/// One to eight cameras around the robot. Throws Error.
[[nodiscard]] std::vector<CameraCount> measure_camera_counts(const Options& options);

void run_camera_count(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
