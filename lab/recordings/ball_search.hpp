// The ball study with the sound search: the same points and frames as for the grid evaluators, W a box.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "depthgrid/search/search.hpp"
#include "lab/recordings/ball_track.hpp"

namespace depthgrid::lab {

/// The recording's cameras with a Kinect's range; their world is its floor frame.
[[nodiscard]] Rig ball_rig(const files::Recording& recording);
/// W is a box around where the ball moves; space that no camera covers is ignored. One margin a camera.
[[nodiscard]] views::Settings ball_search_settings(std::vector<CameraMargins> margins, double v_max_m_s);

/// All answers of one setting with one number of cameras: every choice of that many.
struct BallSearchFigures {
  std::string setting;
  std::size_t cameras = 0;
  std::size_t answers = 0;  ///< the ball's nearest point is covered by a camera of the set, the point outside the ball
  std::size_t at_ball = 0;  ///< nearest point within kBallZone_m of the ball's centre
  std::vector<double> errors_m;  ///< at the ball: answer - (|P - c| - radius)
  std::size_t tested = 0;        ///< with the ball's distance + kTolerance_m below rho, so that the claim can fail
  std::size_t over = 0;          ///< of all answers: answer > ball distance
  std::size_t over_2cm = 0;      ///< by more than the 2 cm to which the ball's place is known
  std::size_t over_absent = 0;   ///< of over: a camera of the set has no part in the ball's track in that frame
  std::size_t over_own = 0;      ///< of the rest: a camera's own fit of the ball lies as far from the point
  std::size_t over_5cm = 0;      ///< by more than kTolerance_m
  double largest_m = 0;          ///< largest answer - ball distance
  /// Answers by state: measured, occluded, unmeasured, nothing within rho, any other.
  std::array<std::size_t, 5> states{};
};

/// Runs over the frames given (indices) under ball_margins() with every choice of one, two and three cameras. Space
/// that no camera covers is ignored, as in the grid study. The world is the recording's floor frame. Throws Error.
[[nodiscard]] std::vector<BallSearchFigures> study_ball_search(files::Recording& recording, const BallTrack& track,
                                                               const std::vector<int>& frames);

[[nodiscard]] std::string ball_search_tables(const std::vector<BallSearchFigures>& rows);

}  // namespace depthgrid::lab
