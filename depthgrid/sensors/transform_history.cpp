#include "depthgrid/sensors/transform_history.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::sensors {
namespace {

/// Some seconds at 1 kHz; older images are no news.
constexpr std::size_t kMostSamples = 4000;
constexpr std::size_t kMostFrames = 10000;
constexpr std::size_t kDeepest = 100;

std::string frame_name(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

std::string quoted(const std::string& name) { return "'" + printable_excerpt(name) + "'"; }

}  // namespace

void TransformHistory::add(const messages::Transforms& message, bool stands) {
  constexpr double kUnit = 1e-3;
  for (const messages::TransformStamped& stamped : message.transforms) {
    const messages::Vector3& t = stamped.transform.translation;
    const messages::Quaternion& q = stamped.transform.rotation;
    Sample sample;
    sample.stamp_ns = messages::nanoseconds(stamped.header.stamp);
    sample.translation = {t.x, t.y, t.z};
    sample.turn = Eigen::Quaternion<double, Eigen::DontAlign>(q.w, q.x, q.y, q.z);
    if (!(std::abs(sample.turn.norm() - 1) <= kUnit) ||
        !(sample.translation.cwiseAbs().maxCoeff() <= kLargestTranslation) || frames_.size() >= kMostFrames) {
      continue;
    }
    sample.turn.normalize();
    Frame& frame = frames_[frame_name(stamped.child_frame_id)];
    const std::string parent = frame_name(stamped.header.frame_id);
    if (frame.parent != parent || frame.stands != stands) {  // it was taken from one and put into another
      frame = {.parent = parent, .stands = stands, .samples = {}};
    }
    if (stands) {
      frame.samples.assign(1, sample);
    } else if (frame.samples.empty() || sample.stamp_ns > frame.samples.back().stamp_ns) {
      frame.samples.push_back(sample);
      if (frame.samples.size() > kMostSamples) {
        frame.samples.pop_front();
      }
    }
  }
}

PlaceAtTime TransformHistory::place(const std::string& name, const Frame& frame, std::int64_t stamp_ns) const {
  const auto pose = [](const Eigen::Vector3d& t, const Eigen::Quaterniond& turn) {
    Pose result = Pose::Identity();
    result.linear() = turn.toRotationMatrix();
    result.translation() = t;
    return result;
  };
  const auto later = std::lower_bound(frame.samples.begin(), frame.samples.end(), stamp_ns,
                                      [](const Sample& sample, std::int64_t ns) { return sample.stamp_ns < ns; });
  if (frame.stands || (later != frame.samples.end() && later->stamp_ns == stamp_ns)) {
    const Sample& sample = frame.stands ? frame.samples.front() : *later;
    return {
        .T_world_frame = pose(sample.translation, Eigen::Quaterniond(sample.turn)), .may_come = false, .reason = {}};
  }
  const double second = 1e-9;
  if (later == frame.samples.end()) {
    const double age_s = static_cast<double>(stamp_ns - frame.samples.back().stamp_ns) * second;
    return {.T_world_frame = {},
            .may_come = true,
            .reason = "the newest transform of frame " + quoted(name) + " on /tf is " + std::to_string(age_s) +
                      " s older than the image"};
  }
  if (later == frame.samples.begin()) {
    return {.T_world_frame = {},
            .may_come = false,
            .reason = "no transform of frame " + quoted(name) + " on /tf is as old as the image"};
  }
  const Sample& before = *(later - 1);
  const double gap_s = static_cast<double>(later->stamp_ns - before.stamp_ns) * second;
  if (gap_s > longest_gap_s_) {
    return {.T_world_frame = {},
            .may_come = false,
            .reason = "about the image's time frame " + quoted(name) + " has no transform on /tf for " +
                      std::to_string(gap_s) + " s, more than " + std::to_string(longest_gap_s_)};
  }
  const double part = static_cast<double>(stamp_ns - before.stamp_ns) * second / gap_s;
  const Eigen::Vector3d t = before.translation + part * (later->translation - before.translation);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(before.turn).slerp(part, Eigen::Quaterniond(later->turn));
  return {.T_world_frame = pose(t, turn.normalized()), .may_come = false, .reason = {}};
}

// Up from the frame to all that it stands in, then up from the world until one of these.
PlaceAtTime TransformHistory::find(const std::string& world, const std::string& frame, std::int64_t stamp_ns) const {
  const auto climb = [&](const std::string& from, const auto& visit) {
    Pose T_at_from = Pose::Identity();
    std::string at = frame_name(from);
    PlaceAtTime result;
    for (std::size_t depth = 0; depth < kDeepest; ++depth) {
      if (visit(at, T_at_from)) {
        return result;
      }
      const auto found = frames_.find(at);
      if (found == frames_.end()) {
        return result;
      }
      result = place(at, found->second, stamp_ns);
      if (!result.T_world_frame) {
        return result;
      }
      T_at_from = *result.T_world_frame * T_at_from;
      at = found->second.parent;
      result.T_world_frame.reset();
    }
    result.reason = "the frames above " + quoted(from) + " go around in a ring";
    return result;
  };
  std::map<std::string, Eigen::Matrix4d> T_above_frame;
  const std::string goal = frame_name(world);
  PlaceAtTime up = climb(frame, [&](const std::string& at, const Pose& T) {
    T_above_frame.emplace(at, T.matrix());
    return at == goal;
  });
  if (!up.reason.empty()) {
    return up;
  }
  std::optional<Pose> T_world_frame;
  PlaceAtTime down = climb(world, [&](const std::string& at, const Pose& T_at_world) {
    const auto met = T_above_frame.find(at);
    if (met == T_above_frame.end()) {
      return false;
    }
    T_world_frame = T_at_world.inverse() * Pose(met->second);
    return true;
  });
  if (!T_world_frame && down.reason.empty()) {
    down.reason = "no transforms on /tf_static and /tf lead from frame " + quoted(frame) + " to " + quoted(world);
  }
  down.T_world_frame = T_world_frame;
  return down;
}

}  // namespace depthgrid::sensors
