// Where the parts that are asked for may be: by the joints' newest state, and what they can have moved since. Internal.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/core/capsule.hpp"
#include "depthgrid/robot/joint_history.hpp"

namespace depthgrid::monitor {

/// One thread. Allocates in its constructor only.
class PartPlaces {
 public:
  explicit PartPlaces(const cell::CellSetup& setup);

  /// At now_s, by what the history held at the moment `known`, into `parts`, one an asked part; world frame. False:
  /// nobody knows where the robot is; parts on it then have no radius. `history` may be null without a robot.
  [[nodiscard]] bool find(double now_s, const robot::JointHistory* history, const robot::JointMoment& known,
                          std::span<Capsule> parts) noexcept;
  /// How far the part may have moved since the joint state, by the last find(); 0 of one that stands still.
  [[nodiscard]] double motion_m(std::size_t part) const noexcept { return part_motion_m_[part]; }

 private:
  /// How far each joint may be from q_ at now_s, into moved_.
  void bound_motion(double now_s, double hold_s, const robot::JointHistory& history,
                    const robot::JointMoment& known) noexcept;

  std::optional<robot::PlacedRobot> robot_;
  std::vector<cell::AskedPart> asked_;
  std::vector<robot::LinkCapsule> links_;  ///< of the parts on the robot, in their order
  std::vector<double> q_;
  double time_error_s_;  ///< between the joints' clock and ours
  std::vector<double> speeds_;
  std::vector<double> accelerations_;  ///< infinite where not declared
  std::vector<double> window_;         ///< how far each joint may be, by the samples
  std::vector<double> moved_;          ///< and by all that is known
  std::vector<Pose> T_world_link_;
  std::vector<Capsule> links_world_;
  std::vector<double> motion_m_;
  std::vector<double> part_motion_m_;
};

}  // namespace depthgrid::monitor
