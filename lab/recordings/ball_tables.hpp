// The ball study as figures and as Markdown tables.
#pragma once

#include <string>

#include "lab/recordings/ball_study.hpp"

namespace depthgrid::lab {

/// All samples of one setting taken with one number of cameras, every camera as principal.
struct BallFigures {
  std::size_t answers = 0;  ///< point and ball in the grid, point outside the ball
  std::size_t at_ball = 0;
  double error_median_m = 0;  ///< answer - (|P - c| - radius), at the ball
  double error_5_m = 0;
  double error_95_m = 0;
  double error_largest_m = 0;  ///< the one that is largest without its sign
  std::size_t elsewhere = 0;   ///< nearest point elsewhere, or none
  std::size_t tested = 0;      ///< of these, with ball distance + tolerance below rho, so that the claim can fail
  std::size_t violations = 0;  ///< answer > ball distance + tolerance
  std::size_t violations_unseen = 0;  ///< of these, in frames where the principal camera does not see the ball
  double worst_excess_m = 0;          ///< largest answer - ball distance of them; NaN when there is none
};

[[nodiscard]] BallFigures ball_figures(const SettingResult& result, std::size_t camera_count);

/// Samples with a shadow obstacle (occluded, unmeasured or unobserved within rho).
struct ShadowFigures {
  std::size_t points = 0;
  std::size_t shadow_one = 0;    ///< with the principal camera alone
  std::size_t unmeasured = 0;    ///< of these, behind a pixel without measurement
  std::size_t shadow_all = 0;    ///< with all cameras
  std::size_t one_not_all = 0;   ///< with the principal camera alone, and none with all
  std::size_t now_measured = 0;  ///< of these, a measured obstacle is nearest with all
  std::size_t now_none = 0;      ///< of these, nothing within rho with all
};

[[nodiscard]] ShadowFigures shadow_figures(const SettingResult& result, std::size_t principal);

[[nodiscard]] std::string ball_tables(const BallStudy& study, const Rig& rig);

}  // namespace depthgrid::lab
