#include "depthgrid/files/transform_tree.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::files {
namespace {

/// Names of older tools begin with a slash that means nothing.
std::string frame_name(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

std::string frame_in_quotes(const std::string& name) { return "'" + printable_excerpt(name) + "'"; }

Pose pose_of(const messages::TransformStamped& stamped) {
  constexpr double kNormTolerance = 1e-3;
  const messages::Vector3& t = stamped.transform.translation;
  const messages::Quaternion& q = stamped.transform.rotation;
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  const Eigen::Vector3d translation(t.x, t.y, t.z);
  const std::string what =
      "transform from " + frame_in_quotes(stamped.child_frame_id) + " to " + frame_in_quotes(stamped.header.frame_id);
  if (!(std::abs(rotation.norm() - 1) <= kNormTolerance)) {
    fail(what, ": its quaternion has the length ", rotation.norm(), ", must be 1");
  }
  if (!(translation.cwiseAbs().maxCoeff() <= kLargestTranslation)) {
    fail(what, ": its translation is ", t.x, ", ", t.y, ", ", t.z, " m, must be within ", kLargestTranslation);
  }
  Pose pose = Pose::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

}  // namespace

void TransformTree::add_static(const messages::Transforms& message) {
  for (const messages::TransformStamped& stamped : message.transforms) {
    const std::string frame = frame_name(stamped.child_frame_id);
    Place place{.parent = frame_name(stamped.header.frame_id), .T_parent_frame = pose_of(stamped)};
    if (frame == place.parent) {
      fail("frame ", frame_in_quotes(frame), " stands in itself");
    }
    const auto [known, is_new] = static_.try_emplace(frame, place);
    if (!is_new && known->second.parent != place.parent) {
      fail("frame ", frame_in_quotes(frame), " stands in ", frame_in_quotes(known->second.parent), " and in ",
           frame_in_quotes(place.parent));
    }
    if (!is_new && known->second.T_parent_frame.matrix() != place.T_parent_frame.matrix()) {
      fail("frame ", frame_in_quotes(frame), " stands in two places of ", frame_in_quotes(place.parent),
           " on /tf_static");
    }
  }
}

void TransformTree::add_moving(const messages::Transforms& message) {
  for (const messages::TransformStamped& stamped : message.transforms) {
    moving_[frame_name(stamped.child_frame_id)] = frame_name(stamped.header.frame_id);
  }
}

std::string TransformTree::root_of(const std::string& frame) const {
  std::string at = frame_name(frame);
  const auto refuse_moving = [&] {
    if (const auto moves = moving_.find(at); moves != moving_.end()) {
      fail("frame ", frame_in_quotes(frame), " moves: ", frame_in_quotes(at), " stands in ",
           frame_in_quotes(moves->second), " by /tf, which changes; give a rig file with a trajectory");
    }
  };
  std::set<std::string> passed{at};
  for (auto place = static_.find(at); place != static_.end(); place = static_.find(at)) {
    refuse_moving();  // even where an old entry says that it stands
    at = place->second.parent;
    if (!passed.insert(at).second) {
      fail("the frames above ", frame_in_quotes(frame), " go around in a ring: ", frame_in_quotes(at),
           " is above itself");
    }
  }
  refuse_moving();
  return at;
}

Pose TransformTree::T_root(const std::string& frame) const {
  const std::string root = root_of(frame);
  Pose T_at_frame = Pose::Identity();
  for (std::string at = frame_name(frame); at != root;) {
    const Place& place = static_.find(at)->second;
    T_at_frame = place.T_parent_frame * T_at_frame;
    at = place.parent;
  }
  return T_at_frame;
}

Pose TransformTree::T(const std::string& world, const std::string& frame) const {
  const std::string name = frame_name(world);
  const std::string root = root_of(frame);
  if (name == root) {
    return T_root(frame);
  }
  if (root_of(name) != root) {
    fail("no transform leads from frame ", frame_in_quotes(frame), " to ", frame_in_quotes(world),
         ": the first ends at ", frame_in_quotes(root), ", the second at ", frame_in_quotes(root_of(name)));
  }
  return T_root(name).inverse() * T_root(frame);
}

bool TransformTree::knows(const std::string& frame) const {
  const std::string name = frame_name(frame);
  return std::any_of(static_.begin(), static_.end(),
                     [&](const auto& placed) { return placed.first == name || placed.second.parent == name; });
}

std::string TransformTree::frames() const {
  constexpr std::size_t kMost = 10;
  std::set<std::string> names;
  for (const auto& [child, place] : static_) {
    names.insert(child);
    names.insert(place.parent);
  }
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (count++ == kMost) {
      return text + ", ...";
    }
    text += (text.empty() ? "" : ", ") + frame_in_quotes(name);
  }
  return text.empty() ? "none" : text;
}

}  // namespace depthgrid::files
