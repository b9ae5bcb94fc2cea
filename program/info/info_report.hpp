// The text that depthgrid info prints.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/info/agreement.hpp"
#include "program/info/depth_noise.hpp"
#include "program/info/depth_quantile.hpp"
#include "program/info/hole_survey.hpp"

namespace depthgrid::program {

/// One camera's images over all frames looked at.
struct CameraSurvey {
  std::int64_t pixels = 0;
  std::int64_t invalid = 0;  ///< without a measured surface
  std::int64_t clamped = 0;  ///< of them, those with a reading beyond far_m (clamp_beyond_far)
  float nearest_m = 0;
  float farthest_m = 0;
  DepthNoise noise;
  DepthQuantile depths;
  /// Of the images as recorded, where lens distortion is removed.
  std::int64_t raw_pixels = 0;
  std::int64_t raw_invalid = 0;
  std::int64_t raw_cut = 0;  ///< measured, but outside the rectified image

  /// An image without clamped readings.
  void add(const DepthImage& depth);
  /// An image before the lens distortion was removed. `read` as Recording::pixels_read().
  void add_distorted(const DepthImage& depth, const std::vector<bool>& read);
};

struct PairSurvey {
  std::size_t a = 0;
  std::size_t b = 0;
  PairAgreement agreement;
};

struct RecordingInfo {
  int frames_used = 0;
  std::vector<CameraSurvey> cameras;  ///< in the rig's order
  std::vector<HoleSurvey> holes;      ///< likewise
  std::vector<PairSurvey> pairs;      ///< ordered pairs; empty where images are not simultaneous
};

struct InfoLimits {
  double limit_m = 5.0;
  double least_overlap = 0.0;
  bool all_pairs = false;
};

std::string to_text(const files::Recording& recording, const RecordingInfo& info, const InfoLimits& limits);

}  // namespace depthgrid::program
