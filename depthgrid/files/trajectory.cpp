#include "depthgrid/files/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/files/image_list.hpp"
#include "depthgrid/files/text_lines.hpp"

namespace depthgrid::files {
namespace {

/// Between poses that turn farther the shortest arc is a guess.
constexpr double kLeastCosine = 0.70710678118654752;  // of half of 90 degrees

double number_of(const LinePlace& place, const char* what, std::string_view word) {
  const auto number = parse_number<double>(word);
  if (!number || !std::isfinite(*number)) {
    fail_at_line(place, what, " is '", printable_excerpt(word), "', must be a finite number");
  }
  return *number;
}

Eigen::Quaterniond rotation_of(const LinePlace& place, std::span<const std::string_view> words) {
  const Eigen::Quaterniond q(number_of(place, "qw", words[3]), number_of(place, "qx", words[0]),
                             number_of(place, "qy", words[1]), number_of(place, "qz", words[2]));
  const double length = q.norm();
  if (!(std::abs(length - 1) <= kRotationTolerance)) {
    fail_at_line(place, "quaternion (qx qy qz qw) has length ", length, ", must be 1 to within ", kRotationTolerance);
  }
  return q.normalized();
}

Eigen::Vector3d translation_of(const LinePlace& place, std::span<const std::string_view> words) {
  Eigen::Vector3d t;
  constexpr std::array<const char*, 3> kNames{"tx", "ty", "tz"};
  for (std::size_t k = 0; k < 3; ++k) {
    t[static_cast<Eigen::Index>(k)] = number_of(place, kNames[k], words[k]);
    if (std::abs(t[static_cast<Eigen::Index>(k)]) > kLargestTranslation) {
      fail_at_line(place, kNames[k], " is '", printable_excerpt(words[k]), "', must be at most 1e5 m from 0");
    }
  }
  return t;
}

std::string seconds(double time_s) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(6) << time_s << " s";
  return text.str();
}

Pose between(const StampedPose& a, const StampedPose& b, double time_s) {
  const Eigen::Quaterniond from(a.T_world_body.linear());
  const Eigen::Quaterniond to(b.T_world_body.linear());
  if (!(std::abs(from.dot(to)) >= kLeastCosine)) {
    fail("there is no pose at ", seconds(time_s), ", and those of ", seconds(a.time_s), " and ", seconds(b.time_s),
         " differ by more than 90 degrees, too far to interpolate");
  }
  const double part = (time_s - a.time_s) / (b.time_s - a.time_s);
  Pose pose = Pose::Identity();
  pose.linear() = from.slerp(part, to).normalized().toRotationMatrix();
  pose.translation() = (1 - part) * a.T_world_body.translation() + part * b.T_world_body.translation();
  return pose;
}

}  // namespace

std::vector<StampedPose> parse_trajectory(std::string_view text, const std::string& name) {
  std::vector<StampedPose> poses;
  for_each_line(text, name, [&](const LinePlace& place, const std::vector<std::string_view>& words) {
    if (words.size() != 8) {
      fail_at_line(place, words.size(), " words, must be 8: time_s tx ty tz qx qy qz qw");
    }
    StampedPose pose;
    pose.time_s = time_of(place, words[0]);
    if (!poses.empty() && !(pose.time_s > poses.back().time_s)) {
      fail_at_line(place, "time '", printable_excerpt(words[0]), "' is not after that of the pose before, must ascend");
    }
    const std::span<const std::string_view> numbers(words);
    pose.T_world_body.translation() = translation_of(place, numbers.subspan(1, 3));
    pose.T_world_body.linear() = rotation_of(place, numbers.subspan(4, 4)).toRotationMatrix();
    poses.push_back(pose);
  });
  if (poses.empty()) {
    fail(name, ": holds no pose, needs lines of: time_s tx ty tz qx qy qz qw");
  }
  return poses;
}

Pose pose_at(std::span<const StampedPose> trajectory, double time_s, std::optional<double> gap_s) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time_s,
                                      [](const StampedPose& pose, double t) { return pose.time_s < t; });
  if (after != trajectory.end() && after->time_s - time_s <= kSameInstant_s) {
    return after->T_world_body;
  }
  if (after != trajectory.begin() && time_s - (after - 1)->time_s <= kSameInstant_s) {
    return (after - 1)->T_world_body;
  }
  if (after == trajectory.begin() || after == trajectory.end()) {
    fail("there is no pose at ", seconds(time_s), ": the trajectory ",
         after == trajectory.end() ? "ends at " : "begins at ",
         seconds(after == trajectory.end() ? trajectory.back().time_s : trajectory.front().time_s),
         ", and nothing is carried beyond it; choose other frames with --frames");
  }
  const StampedPose& a = *(after - 1);
  const StampedPose& b = *after;
  if (!gap_s) {
    fail("there is no pose at ", seconds(time_s), ", the nearest are ", time_s - a.time_s, " s before and ",
         b.time_s - time_s,
         " s after; state /frames/pose_gap_s to interpolate between poses that are no farther apart");
  }
  if (!(b.time_s - a.time_s <= *gap_s)) {
    fail("there is no pose at ", seconds(time_s), ", and those around it are ", b.time_s - a.time_s,
         " s apart, more than /frames/pose_gap_s = ", *gap_s, "; choose other frames with --frames");
  }
  return between(a, b, time_s);
}

Pose parse_pose_matrix(std::string_view text, const std::string& name) {
  std::vector<double> numbers;
  for_each_line(text, name, [&](const LinePlace& place, const std::vector<std::string_view>& words) {
    for (const std::string_view word : words) {
      const auto number = parse_number<double>(word);
      if (!number) {
        fail_at_line(place, "'", printable_excerpt(word), "' is no number, a pose is 16 of them, a 4 x 4 matrix");
      }
      if (!std::isfinite(*number)) {
        fail_at_line(place, "the pose is missing ('", printable_excerpt(word),
                     "': the camera was lost); choose other frames with --frames");
      }
      numbers.push_back(*number);
      if (numbers.size() > 16) {
        fail_at_line(place, "more than 16 numbers, a pose is a 4 x 4 matrix");
      }
    }
  });
  if (numbers.size() != 16) {
    fail(name, ": ", numbers.size(), " numbers, a pose is 16 of them, a 4 x 4 matrix");
  }
  Eigen::Matrix4d matrix;
  for (Eigen::Index k = 0; k < 16; ++k) {
    matrix(k / 4, k % 4) = numbers[static_cast<std::size_t>(k)];
  }
  Pose pose = pose_from_matrix(matrix, name.c_str());
  if (!(pose.translation().cwiseAbs().maxCoeff() <= kLargestTranslation)) {
    fail(name, ": the translation reaches ", pose.translation().cwiseAbs().maxCoeff(), " m, must be at most ",
         kLargestTranslation);
  }
  return pose;
}

}  // namespace depthgrid::files
