// Measured rows of the grid evaluators' benchmark.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/grid/evaluation.hpp"
#include "lab/workload/workload.hpp"

namespace depthgrid::lab {

/// What is measured: an evaluator's settings under a name.
struct RateMethod {
  std::string name;
  grid::EvaluationSettings settings;
  int repetition_divisor = 1;  ///< slow methods are repeated less often
};

/// `letter` and `corrected`, each with the hybrid vector and with the minimum only; rho = 0.4 m, ideal sensor.
[[nodiscard]] std::vector<RateMethod> rate_methods();

/// One method with one number of cameras.
struct RateRow {
  std::string name;
  int cameras = 0;
  std::vector<double> evaluation_s;  ///< CPU time of each evaluation of all nine points
  std::vector<double> update_s;      ///< CPU time of each frame set
  std::vector<double> distances_m;   ///< rho where nothing is nearer
  grid::EvaluationCount count;

  /// Evaluations of all nine points a second of CPU time.
  [[nodiscard]] double rate() const;
};

/// 1 cm cells, 640x480x343, as the letter has them. New control points for every evaluation.
[[nodiscard]] RateRow measure_rate(const Workload& workload, int cameras, const RateMethod& method, int repetitions);

}  // namespace depthgrid::lab
