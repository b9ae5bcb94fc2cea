#include "program/info/calibration_report.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>

namespace depthgrid::program {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// The parts streamed into one text, numbers with `digits` behind the point.
template <class... Parts>
std::string fixed(int digits, const Parts&... parts) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits);
  (text << ... << parts);
  return text.str();
}

double degrees_seen(double centre_px, int side_px, double focal_px) {
  return kDegrees * (std::atan(centre_px / focal_px) + std::atan((side_px - centre_px) / focal_px));
}

double percent_of(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

struct Neighbour {
  std::size_t camera;
  double distance_m;
  double angle_rad;
};

std::optional<Neighbour> nearest_camera(const Rig& rig, std::size_t k) {
  std::optional<Neighbour> nearest;
  const Pose& own = rig.cameras[k].T_world_camera;
  for (std::size_t other = 0; other < rig.cameras.size(); ++other) {
    const Pose T = own.inverse() * rig.cameras[other].T_world_camera;
    if (other != k && (!nearest || T.translation().norm() < nearest->distance_m)) {
      nearest = {other, T.translation().norm(), Eigen::AngleAxisd(T.linear()).angle()};
    }
  }
  return nearest;
}

std::string remark(const std::string& text) { return "  ! " + text + "\n"; }

std::string depth_remarks(const RigCamera& camera, const CameraSurvey& survey) {
  constexpr double kSuspiciouslyFar_m = 20.0;
  constexpr double kSuspiciouslyNear_m = 0.15;
  const double median_m = survey.depths.median_m();
  if (survey.pixels == survey.invalid) {
    return remark("no reading in these frames: are near_m, far_m and invalid_values right?");
  }
  std::ostringstream scale;
  scale << camera.metres_per_unit;
  const std::string end = ": is metres_per_unit (" + scale.str() + ") right? For images in millimetres it is 0.001";
  if (median_m > kSuspiciouslyFar_m) {
    return remark(fixed(0, "half of the readings are farther than ", median_m, " m") + end);
  }
  if (median_m < kSuspiciouslyNear_m) {
    return remark(fixed(3, "half of the readings are nearer than ", median_m, " m") + end);
  }
  return {};
}

std::string centre_remark(const PinholeCamera& camera, bool distorted) {
  constexpr double kOffCentre = 0.15;
  const double off =
      std::max(std::abs(camera.cx_px / camera.width_px - 0.5), std::abs(camera.cy_px / camera.height_px - 0.5));
  if (distorted || off <= kOffCentre) {
    return {};
  }
  return remark(fixed(0, "the principal point is ", 100 * off,
                      " % of the image off its middle: is the calibration for another image size?"));
}

std::string lens_text(const RigCamera& camera, const CameraSurvey& survey, const std::vector<bool>& read) {
  constexpr double kMuch = 5.0;
  const auto unread = static_cast<std::int64_t>(std::count(read.begin(), read.end(), false));
  const double cut = percent_of(survey.raw_cut, survey.raw_pixels - survey.raw_invalid);
  std::string text =
      fixed(1, "  lens distortion removed: ", percent_of(survey.raw_invalid, survey.raw_pixels),
            " % of the recorded image without measurement; the rectified one, ", camera.intrinsics.width_px, " x ",
            camera.intrinsics.height_px, ", leaves out ", percent_of(unread, static_cast<std::int64_t>(read.size())),
            " % of the recorded image and ", cut, " % of its readings\n");
  return cut > kMuch ? text + remark("what is left out counts as not observed") : text;
}

}  // namespace

std::string calibration_text(const files::Recording& recording, const RecordingInfo& info) {
  constexpr double kSamePlace_m = 1e-3;
  constexpr double kSameAngle_rad = 1e-3;
  const Rig& rig = recording.rig();
  std::string text = "calibration: field of view; nearest, median, farthest reading; nearest other camera\n";
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const RigCamera& camera = rig.cameras[k];
    const CameraSurvey& survey = info.cameras[k];
    const std::vector<bool> read = recording.pixels_read(k);
    const PinholeCamera& c = camera.intrinsics;
    text += camera.id + std::string(camera.id.size() < 17 ? 17 - camera.id.size() : 0, ' ') +
            fixed(1, " ", degrees_seen(c.cx_px, c.width_px, c.fx_px), " x ",
                  degrees_seen(c.cy_px, c.height_px, c.fy_px), " degrees; ") +
            (survey.pixels == survey.invalid
                 ? std::string("no reading")
                 : fixed(2, static_cast<double>(survey.nearest_m), ", ",
                         std::clamp(survey.depths.median_m(), static_cast<double>(survey.nearest_m),
                                    static_cast<double>(survey.farthest_m)),
                         ", ", static_cast<double>(survey.farthest_m), " m"));
    const std::optional<Neighbour> nearest = nearest_camera(rig, k);
    text += nearest ? fixed(3, "; ", nearest->distance_m, " m from ", rig.cameras[nearest->camera].id, "\n")
                    : std::string("\n");
    text += read.empty() ? std::string() : lens_text(camera, survey, read);
    text += depth_remarks(camera, survey) + centre_remark(c, !read.empty());
    if (nearest && nearest->distance_m < kSamePlace_m && nearest->angle_rad < kSameAngle_rad) {
      text += remark("stands and looks where " + rig.cameras[nearest->camera].id + " does: was a pose left out?");
    }
  }
  return text;
}

}  // namespace depthgrid::program
