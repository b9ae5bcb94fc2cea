// The text that depthgrid info prints.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/info/agreement.hpp"
#include "program/info/depth_noise.hpp"

namespace depthgrid::program {

/// One camera's images over all frames looked at.
struct CameraSurvey {
  std::int64_t pixels = 0;
  std::int64_t invalid = 0;
  float nearest_m = 0;
  float farthest_m = 0;
  DepthNoise noise;

  void add(const DepthImage& depth);
};

struct PairSurvey {
  std::size_t a = 0;
  std::size_t b = 0;
  PairAgreement agreement;
};

struct RecordingInfo {
  int frames_used = 0;
  std::vector<CameraSurvey> cameras;  ///< in the rig's order
  std::vector<PairSurvey> pairs;      ///< ordered pairs; empty where images are not simultaneous
};

struct InfoLimits {
  double limit_m = 5.0;
  double least_overlap = 0.0;
  bool all_pairs = false;
};

std::string to_text(const files::Recording& recording, const RecordingInfo& info, const InfoLimits& limits);

}  // namespace depthgrid::program
