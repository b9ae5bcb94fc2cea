// Where frames stand in each other over time, by messages of /tf_static and /tf.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/messages/transforms.hpp"

namespace depthgrid::sensors {

/// What is known of a frame's place at a time.
struct PlaceAtTime {
  std::optional<Pose> T_world_frame{};
  bool may_come = false;  ///< a moving frame's newest transform is older than that time: another may come
  std::string reason{};   ///< why it is not known; empty where it is
};

/// Not thread-safe. A frame name's slash in front does not count.
class TransformHistory {
 public:
  /// Over a gap between two transforms of a frame that is longer than this nothing is interpolated.
  explicit TransformHistory(double longest_gap_s) : longest_gap_s_(longest_gap_s) {}

  /// Transforms that are no rigid ones, and a second one of the same time, are passed over. So are those of frames that
  /// move which lie later than `now_ns` by more than clocks may differ: everything after them would look old. One that
  /// is older than the last of its frame forgets that frame's others: whoever says it has set its clock back.
  void add(const messages::Transforms& message, bool stands, std::int64_t now_ns);
  /// Of frames that move; of those that stand nothing is of a time.
  void forget_moving();

  /// p_world = T * p_frame at the stamp. Of frames that move it is interpolated between the transforms before and
  /// after; none is held: then `may_come`.
  [[nodiscard]] PlaceAtTime find(const std::string& world, const std::string& frame, std::int64_t stamp_ns) const;

 private:
  struct Sample {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Quaternion<double, Eigen::DontAlign> turn = Eigen::Quaternion<double, Eigen::DontAlign>::Identity();
  };
  struct Frame {
    std::string parent;
    bool stands = false;
    std::deque<Sample> samples;  ///< ascending; one that stands has one
  };
  /// In its parent.
  [[nodiscard]] PlaceAtTime place(const std::string& name, const Frame& frame, std::int64_t stamp_ns) const;

  double longest_gap_s_;
  std::map<std::string, Frame> frames_;
  std::string refused_frame_;  ///< whose newest transform lies in the future; empty: none
  double refused_s_ = 0;       ///< how far
};

}  // namespace depthgrid::sensors
