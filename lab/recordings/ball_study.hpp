// Distances around a ball of known size and place, with one, two and three cameras.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "lab/recordings/ball_track.hpp"
#include "lab/recordings/gray_area.hpp"

namespace depthgrid::lab {

/// Where an answer came from and how it compares with the ball.
struct Sample {
  std::uint8_t principal = 0;
  std::uint8_t cameras = 0;   ///< number of cameras used
  bool inside = false;        ///< point and the ball's nearest point both lie in the principal camera's grid
  bool ball_seen = false;     ///< the principal camera sees the ball's centre region (it is in its image, unhidden)
  float ball_distance_m = 0;  ///< |P - c| - radius
  float distance_m = 0;       ///< the answer; NaN where there is none
  bool at_ball = false;       ///< nearest point within 0.26 m of the ball's centre
  ProximityState state = ProximityState::not_evaluated;
};

struct Setting {
  std::string name;
  grid::EvaluationSettings evaluation;
  std::size_t frame_step = 1;  ///< only every n-th of the frames: for settings that take long
};

/// letter; corrected without margins; with the Kinect's margins; with those and a pose margin of 3 cm.
[[nodiscard]] std::vector<Setting> ball_settings();

/// Samples of one setting, all camera sets side by side: samples[i] of each set belong to the same point and frame.
struct SettingResult {
  Setting setting;
  struct SetResult {
    CameraSet cameras;
    std::vector<Sample> samples;
    double seconds = 0;  ///< spent in evaluate()
  };
  std::vector<SetResult> sets;
};

struct BallStudy {
  std::vector<SettingResult> settings;
  std::vector<std::pair<CameraSet, GrayArea>> gray;  ///< sets of at least two cameras
  std::size_t frames = 0;
  std::size_t points_per_frame = 0;
};

inline constexpr double kBallZone_m = 0.26;
inline constexpr double kTolerance_m = 0.05;

/// Control points of one frame in the floor frame: 14 directions around the ball at 0.30, 0.40 and 0.60 m from its
/// centre, and 18 fixed places over the volume in which the ball moves.
[[nodiscard]] std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& ball_floor);

/// Depth cells of the study: the letter's d_min and step, to 5 m.
[[nodiscard]] grid::DepthQuantisation ball_cells();
/// The volume in which the ball moves, with room around: a box in the floor frame.
[[nodiscard]] Eigen::AlignedBox3d ball_workspace_floor();

/// Runs over the frames given (indices), every camera as principal in turn. `progress(done, total)` may be empty.
[[nodiscard]] BallStudy study_ball(files::Recording& recording, const BallTrack& track, const std::vector<int>& frames,
                                   const std::vector<Setting>& settings,
                                   const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace depthgrid::lab
