// Where frames stand in each other, from messages of /tf_static and /tf. Internal.
#pragma once

#include <map>
#include <string>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/messages/transforms.hpp"

namespace depthgrid::files {

/// Frames that stand in their parents, and those that move in them.
class TransformTree {
 public:
  /// Transforms that never change. Throws Error for a frame within itself, one that stands in two places or in two
  /// parents, and numbers that are no rigid transform.
  void add_static(const messages::Transforms& message);
  /// Their frames move: where, does not count.
  void add_moving(const messages::Transforms& message);

  /// The frame that the chain of parents of `frame` ends at; itself where it has none. Throws Error where a frame on
  /// the way moves, or the chain goes around in a ring.
  [[nodiscard]] std::string root_of(const std::string& frame) const;
  /// p_root = T_root_frame * p_frame. Throws as root_of().
  [[nodiscard]] Pose T_root(const std::string& frame) const;
  /// p_world = T * p_frame. Throws Error that names both where no transforms lead from one to the other.
  [[nodiscard]] Pose T(const std::string& world, const std::string& frame) const;

  [[nodiscard]] bool knows(const std::string& frame) const;
  /// "'base', 'camera', ...", at most some ten.
  [[nodiscard]] std::string frames() const;

 private:
  struct Place {
    std::string parent;
    Pose T_parent_frame;
  };
  std::map<std::string, Place, std::less<>> static_;
  std::map<std::string, std::string, std::less<>> moving_;  ///< its parent
};

}  // namespace depthgrid::files
