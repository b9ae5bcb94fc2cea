// Leave one camera out, on the recordings: rates of violations and what is found there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "lab/recordings/left_out_causes.hpp"

namespace depthgrid::lab {

struct LeftOutRow {
  std::string setting;
  std::string left_out;
  LeftOutFigures figures;
};

struct MarkedReading {
  LeftOutReading reading;
  LeftOutCause cause;
};

/// What is left out: one image.
struct LeftOutImage {
  const RigCamera& camera;
  const CameraMargins& margins;
  const DepthImage& depth;   ///< measured
  const DepthImage& median;  ///< as in cause_of()
  Pose T_floor_world;
};

/// Checks one image. Adds to `figures`; the violating readings are appended to `marked` unless that is null.
void check_left_out(LeaveOneOut& others, const LeftOutImage& image, int stride, LeftOutFigures& figures,
                    std::vector<MarkedReading>* marked);

/// kinect3_ball: every camera left out in turn, in the frames given (indices), under ball_margins(); every
/// `stride`-th pixel of every `stride`-th row. The medians are taken over `frames`. Throws Error.
[[nodiscard]] std::vector<LeftOutRow> ball_leave_one_out(files::Recording& recording, const std::vector<int>& frames,
                                                         int stride);

/// redkitchen_poses as one camera that moves: every image is checked against the four before it, each at its own pose,
/// and then takes the place of the oldest. Then the rigs of four images that the recording suggests, each image left
/// out in turn. Throws Error.
[[nodiscard]] std::vector<LeftOutRow> kitchen_leave_one_out(int stride);

[[nodiscard]] std::string left_out_tables(const std::vector<LeftOutRow>& rows);

/// The three images of a frame with their violating readings (every second pixel), without margins and with the
/// sensor's.
void save_left_out_picture(const std::filesystem::path& file, files::Recording& recording,
                           const std::vector<int>& frames, int frame);

}  // namespace depthgrid::lab
