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
/// In the future, on clocks that agree not quite. As images may be.
constexpr std::int64_t kFuture_ns = 5'000'000;

std::string frame_name(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

std::string quoted(const std::string& name) { return "'" + printable_excerpt(name) + "'"; }

}  // namespace

void TransformHistory::add(const messages::Transforms& message, bool stands, std::int64_t now_ns) {
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
    const std::string name = frame_name(stamped.child_frame_id);
    if (!stands && sample.stamp_ns - now_ns > kFuture_ns) {
      refused_frame_ = name;
      refused_s_ = static_cast<double>(sample.stamp_ns - now_ns) * 1e-9;
      continue;
    }
    if (refused_frame_ == name) {
      refused_frame_.clear();
    }
    Frame& frame = frames_[name];
    const std::string parent = frame_name(stamped.header.frame_id);
    if (frame.parent != parent || frame.stands != stands) {  // it was taken from one and put into another
      frame = {.parent = parent, .stands = stands, .samples = {}};
    }
    if (stands) {
      frame.samples.assign(1, sample);
      continue;
    }
    // By the clock that is set back, images would be found where the frame was at these times before.
    if (!frame.samples.empty() && sample.stamp_ns < frame.samples.back().stamp_ns) {
      frame.samples.clear();
    }
    if (frame.samples.empty() || sample.stamp_ns > frame.samples.back().stamp_ns) {
      frame.samples.push_back(sample);
      if (frame.samples.size() > kMostSamples) {
        frame.samples.pop_front();
      }
    }
  }
}

void TransformHistory::forget_moving() {
  std::erase_if(frames_, [](const auto& named) { return !named.second.stands; });
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
  const auto with_refused = [this](PlaceAtTime place) {
    if (!place.T_world_frame && !refused_frame_.empty()) {
      place.reason += "; a transform of frame " + quoted(refused_frame_) + " that lies " + std::to_string(refused_s_) +
                      " s in the future was refused";
    }
    return place;
  };
  if (!up.reason.empty()) {
    return with_refused(up);
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
  return with_refused(down);
}

}  // namespace depthgrid::sensors
