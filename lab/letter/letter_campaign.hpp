// By how much the letter's and the corrected evaluation err on random scenes, measured against the oracle's interval.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lab/letter/letter_model.hpp"

namespace depthgrid::lab {

/// One class of scenes.
struct CampaignSettings {
  std::uint64_t seed = 1;
  int scenes = 1000;
  int secondaries = 1;
  int width_px = 0;  ///< 0: 48 to 96 px, by the seed
  int threads = 0;   ///< 0: one a core
};

/// One control point. Errors in metres: over = answer - hi, under = lo - answer, 0 where negative. Where nothing was
/// found the answer is rho, so the true over-estimate may be larger.
struct PointErrors {
  struct Error {
    double over_m = 0;
    double under_m = 0;
  };
  Error letter_printed;  ///< window (8)-(9)
  Error letter_whole;    ///< whole image
  Error corrected;
  /// Over-estimate of the letter's model after the first n mends, n = 0 .. kMendCount.
  std::array<double, kMendCount + 1> over_after_mends_m{};
  bool model_agrees = false;  ///< the model and the product's evaluation, as printed, agree within 0.1 mm
  bool within_rho = false;    ///< the oracle found an obstacle within rho
  bool point_free = false;    ///< the point itself is not in an obstacle
  bool decided = false;       ///< the oracle's interval is narrower than 2 mm
  std::string worst_line;     ///< the problem, for a repetition
};

/// Calls progress(done, total) now and then from this thread.
std::vector<PointErrors> run_campaign(const CampaignSettings& settings,
                                      const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace depthgrid::lab
