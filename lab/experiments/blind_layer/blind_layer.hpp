// What a hand near a link reads, by the padding of the robot's removal.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/experiments/experiment.hpp"

namespace depthgrid::experiments {

/// One scene with one padding: the middle one of several images where the sensor has noise.
struct LayerReading {
  std::string sensor;  ///< with kDeclared behind it: with what is declared for it and a memory
  double padding_m = 0;
  std::optional<double> gap_m;  ///< from the link's surface to the hand's: the truth; none: no hand
  double distance_m = 0;        ///< D
  std::string state;
  double blind_m = 0;
  double clear_m = 0;  ///< D less the layer, and not negative
};

inline constexpr std::string_view kDeclared = ", declared";

/// Sensors ideal and kinect_v1, or the one that is given, without and with what is declared for it; gaps 0.02 to 0.2 m
/// and no hand, paddings 0 to 0.35 m. Throws Error. `pictures` may be
/// null.
[[nodiscard]] std::vector<LayerReading> measure_blind_layer(const Options& options, ExperimentReport* pictures);

void run_blind_layer(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
