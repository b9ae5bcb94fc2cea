#include "program/distances/recorded_robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/motion_padding.hpp"
#include "depthgrid/robot/robot_parts.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "program/usage_error.hpp"
#include "report/number_text.hpp"

namespace depthgrid::program {

namespace {

robot::PlacedRobot placed_robot(const RecordedRobotOptions& options, const Pose& T_world_rig) {
  return {robot::RobotModel(robot::load_urdf(options.robot.file, urdf_options(options.robot))),
          T_world_rig * base_pose(options.base.value())};
}

/// Numbers above `value` are in a smaller unit; `hint` asks.
struct Largest {
  double value;
  const char* hint;
};
constexpr Largest kPadding_m{1, " m (in millimetres?)"};
constexpr Largest kTimeError_s{60, " s (in milliseconds?)"};
constexpr Largest kAnySpeed{std::numeric_limits<double>::infinity(), ""};

double checked(std::optional<double> value, double otherwise, const char* option, const Largest& limit) {
  const double result = value.value_or(otherwise);
  if (!(std::isfinite(result) && result >= 0)) {
    fail_usage(option, " ", result, " must be finite and not negative");
  }
  if (result > limit.value) {
    fail_usage(option, " ", result, " must be at most ", limit.value, limit.hint);
  }
  return result;
}

/// How far an image's time may be from the joints': as stated, else the largest of the cameras.
double time_error_s(const RecordedRobotOptions& options, const Rig& rig, bool by_frame) {
  double largest_s = 0;
  for (const RigCamera& camera : rig.cameras) {
    if (camera.margins && !by_frame) {
      largest_s = std::max(largest_s, camera.margins->half_exposure_s + camera.margins->time_uncertainty_s);
    }
  }
  return checked(options.joint_time_error_s, largest_s, "--joint-time-error", kTimeError_s);
}

/// The URDF's greatest speeds; --joint-speed where it states none. Nothing needs them without an error of time.
std::vector<double> joint_speeds(const RecordedRobotOptions& options, const robot::RobotModel& model, double error_s) {
  const double other = checked(options.joint_speed, 0, "--joint-speed", kAnySpeed);
  std::vector<double> speeds;
  speeds.reserve(model.joints().size());
  for (const robot::Joint& joint : model.joints()) {
    const bool stated = std::isfinite(joint.max_speed);
    if (!stated && error_s > 0 && !options.joint_speed) {
      fail_usage(
          "joint '", joint.name, "' of ", model.source(), " has no greatest speed, and an image may be ", error_s,
          " s beside the joint positions: state --joint-speed, or --joint-time-error 0 if the robot stood still");
    }
    speeds.push_back(stated ? joint.max_speed : other);
  }
  return speeds;
}

const char* why_unknown(robot::JointAnswer answer) {
  switch (answer) {
    case robot::JointAnswer::too_old:
      return "it was taken before the first row";
    case robot::JointAnswer::too_new:
      return "it was taken after the last row";
    case robot::JointAnswer::gap:
      return "the rows around it are farther apart than --joint-gap";
    default:
      return "there is no row";
  }
}

}  // namespace

RecordedRobot::RecordedRobot(const RecordedRobotOptions& options, const Rig& rig, const Pose& T_world_rig,
                             const ImageTimes& times)
    : rig_(rig),
      robot_(placed_robot(options, T_world_rig)),
      start_s_(times.start_s),
      padding_m_(checked(options.padding_m, 0, "--robot-padding", kPadding_m)),
      joints_(recorded_joints(options, robot_.model)),
      T_world_link_(robot_.model.links().size(), Pose::Identity()),
      at_joint_times_(rig.cameras.size()),
      frames_(rig.cameras.size()),
      pixels_(rig.cameras.size()),
      counts_(rig.cameras.size()),
      deepest_m_(rig.cameras.size(), 0.0) {
  const bool by_frame = !joints_.frames.empty();
  if (by_frame && times.stamped) {
    fail(options.joints_file,
         ": gives joint positions by frame number, but the images have time stamps, each its own: give their times in "
         "a column 'time', on the images' clock");
  }
  if (!by_frame && !times.known) {
    fail(options.joints_file,
         ": gives joint positions over time, but the recording says no times of its images (\"rate_hz\" in its rig "
         "file): add a column 'frame' with their numbers");
  }
  time_error_s_ = time_error_s(options, rig, by_frame);
  joint_speeds_ = joint_speeds(options, robot_.model, time_error_s_);
  robot::ExposureSettings settings;
  settings.removal.padding_m = padding_m_;
  settings.time_error_s = time_error_s_;
  settings.joint_speeds = joint_speeds_;
  padded_ = std::make_unique<robot::FrameIntake>(rig_, robot_, *joints_.history, settings);
  settings.removal = {.padding_m = 0, .whole_pixels = false};
  settings.time_error_s = 0;
  bare_ = std::make_unique<robot::FrameIntake>(rig_, robot_, *joints_.history, settings);
  parts_ = robot::moving_capsules(robot_.model, least_joints());
  for (const RigCamera& camera : rig_.cameras) {
    measured_m_.emplace_back(camera.intrinsics.width_px, camera.intrinsics.height_px);
  }
}

std::span<const Frame> RecordedRobot::frames(int frame_number, std::span<const Frame> seen, const Rig& rig) {
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const auto time_s = joints_.time_of(frame_number, start_s_ + seen[k].time_s);
    if (!time_s) {
      fail(joints_.file, ": has no row of frame ", frame_number, "; leave it out with --frames");
    }
    at_joint_times_[k] = {seen[k].depth, {}, *time_s};
    frames_[k] = seen[k];
    if (seen[k].depth.data == nullptr) {
      pixels_[k].assign(measured_m_[k].index(0, measured_m_[k].height_px()), RobotPixel::none);
      continue;
    }
    const Pose& T_world_camera = rig.cameras[k].T_world_camera;
    const Frame padded = padded_->frame(k, at_joint_times_[k], T_world_camera);
    const Frame bare = bare_->frame(k, at_joint_times_[k], T_world_camera);
    const robot::JointsAtTime& joints = padded_->report()[k].joints;
    if (!joints.known()) {
      fail(joints_.file, ": frame ", frame_number, ", camera '", rig_.cameras[k].id, "', at ",
           report::micro_text(at_joint_times_[k].time_s), " s: its joint positions are not known, ",
           why_unknown(joints.answer), "; rows go from ", report::micro_text(joints_.first_s), " to ",
           report::micro_text(joints_.last_s), " s: leave it out with --frames, or state --joint-time-offset");
    }
    frames_[k] = {padded.depth, padded.robot, seen[k].time_s};
    count(k, frames_[k], bare.robot);
  }
  newest_s_ = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < seen.size(); ++k) {
    newest_s_ = seen[k].depth.data != nullptr ? std::max(newest_s_, at_joint_times_[k].time_s) : newest_s_;
  }
  std::vector<double> q(robot_.model.joints().size());
  (void)joints_.history->at(newest_s_, q);
  (void)robot_.link_poses(q, T_world_link_);
  return frames_;
}

void RecordedRobot::count(std::size_t camera, const Frame& frame, const RobotView& bare) {
  const RigCamera& setup = rig_.cameras[camera];
  DepthImage& measured_m = measured_m_[camera];
  normalise(frame.depth, setup.rule, measured_m);
  const SensorMargin none{0, 0, 0, 0};
  classify_robot_pixels(measured_m, frame.robot, bare, setup.margins ? setup.margins->sensor : none, pixels_[camera]);
  counts_[camera].add(pixels_[camera]);
  const std::ptrdiff_t stride = bare.stride_px == 0 ? setup.intrinsics.width_px : bare.stride_px;
  for (int v = 0; bare.near_m != nullptr && v < setup.intrinsics.height_px; ++v) {
    const float* const row = bare.near_m + v * stride;
    deepest_m_[camera] =
        std::max(deepest_m_[camera], static_cast<double>(*std::max_element(row, row + setup.intrinsics.width_px)));
  }
}

std::vector<double> RecordedRobot::motion_m() const {
  const std::vector<robot::LinkCapsule> capsules = robot::link_capsules(robot_.model);
  std::vector<double> q(joint_speeds_.size());
  (void)joints_.history->at(newest_s_, q);
  // As robot::RobotAtExposure without accelerations.
  const std::vector<double> unknown(q.size(), std::numeric_limits<double>::infinity());
  std::vector<double> moved(q.size());
  const bool is_measured = joints_.history->greatest_motion(newest_s_, time_error_s_, q, joint_speeds_, unknown, moved);
  for (std::size_t j = 0; j < moved.size(); ++j) {
    const double at_most = joint_speeds_[j] * time_error_s_;
    moved[j] = is_measured ? std::min(moved[j], at_most) : at_most;
  }
  std::vector<double> result(capsules.size());
  robot::motion_padding(robot_.model, capsules, T_world_link_, moved, 1.0, result);
  return result;
}

std::vector<files::ControlPoint> RecordedRobot::link_capsules() const {
  std::vector<Capsule> capsules(parts_.size());
  robot::place(parts_, T_world_link_, capsules);
  std::vector<files::ControlPoint> points;
  points.reserve(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    points.push_back({robot_.model.links()[parts_[i].link].name, capsules[i], capsules[i].a != capsules[i].b});
  }
  return points;
}

bool RecordedRobot::is_in_an_image() const noexcept {
  return std::any_of(counts_.begin(), counts_.end(),
                     [](const RobotPixelCount& count) { return count.on_capsules() > 0; });
}

std::vector<std::string> RecordedRobot::pixel_lines() const {
  std::vector<std::string> lines;
  lines.reserve(counts_.size());
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    lines.push_back(to_text(counts_[k], rig_.cameras[k].id));
  }
  return lines;
}

std::vector<std::string> RecordedRobot::padding_lines() const {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
    const double missing_m = padded_->missing_padding_m(k, deepest_m_[k]).value_or(0);
    if (deepest_m_[k] > 0 && missing_m > 0) {
      const double least_m = std::ceil(1e3 * (padding_m_ + missing_m)) / 1e3;
      lines.push_back("camera '" + rig_.cameras[k].id + "': --robot-padding " + report::exact_text(padding_m_) +
                      " is less than the sensor's margin at the robot, up to " + report::fixed(least_m, 3) + " m at " +
                      report::fixed(deepest_m_[k], 2) +
                      " m, so the robot may be its own obstacle: state at least --robot-padding " +
                      report::fixed(least_m, 3) + ", more for the errors of model, calibration and base");
    }
  }
  return lines;
}

void one_answer_a_link(std::vector<files::ControlPoint>& points, std::vector<Answer>& answers) {
  const auto worse = [](const Answer& a, const Answer& b) {
    if (has_distance(a.nearest) != has_distance(b.nearest)) {
      return !has_distance(a.nearest);
    }
    return a.nearest.distance_m < b.nearest.distance_m;
  };
  std::vector<files::ControlPoint> links;
  std::vector<Answer> of_links;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found =
        std::find_if(links.begin(), links.end(), [&](const auto& link) { return link.id == points[i].id; });
    if (found == links.end()) {
      links.push_back(points[i]);
      of_links.push_back(answers[i]);
      continue;
    }
    Answer& kept = of_links[static_cast<std::size_t>(found - links.begin())];
    // What holds for a part holds for the link.
    const double known_to_m = std::fmin(kept.nearest.known_to_m, answers[i].nearest.known_to_m);
    const bool stale = kept.nearest.stale || answers[i].nearest.stale;
    const bool budget = kept.nearest.budget || answers[i].nearest.budget;
    if (worse(answers[i], kept)) {
      *found = points[i];
      kept = answers[i];
    }
    kept.nearest.known_to_m = has_distance(kept.nearest) ? known_to_m : kept.nearest.known_to_m;
    kept.nearest.stale = stale;
    kept.nearest.budget = budget;
  }
  points = std::move(links);
  answers = std::move(of_links);
}

}  // namespace depthgrid::program
