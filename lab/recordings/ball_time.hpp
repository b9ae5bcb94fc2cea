// How long the search takes on the recording of the ball.
#pragma once

#include <string>

#include "depthgrid/files/recording.hpp"
#include "lab/recordings/ball_track.hpp"

namespace depthgrid::lab {

/// A Markdown table: nine points 0.4 m around the ball, three cameras, a Kinect's margins with pose errors of 2 cm and
/// 9 mrad, every frame in which the ball is tracked; the first call after the images and ten with other points, up to 2
/// cm beside them along each axis. Processor time. Throws Error.
[[nodiscard]] std::string ball_time_table(files::Recording& recording, const BallTrack& track);

}  // namespace depthgrid::lab
