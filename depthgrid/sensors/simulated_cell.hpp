// A robot cell that runs by the clock: an arm at work, a person who comes and goes, cameras that see them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/placed_robot.hpp"
#include "depthgrid/simulation/person_script.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::sensors {

struct SimulatedCellSettings {
  std::optional<robot::PlacedRobot> robot{};
  bool person = true;  ///< walks in, stands beside the robot, leaves, and comes again
  std::uint64_t seed = 1;
  std::optional<double> begin_s{};  ///< at which its time is 0: processes that share a clock show one cell; none: now
};

/// The room of simulation::empty_workcell(): the robot's base should stand at the world's origin.
/// - Units: seconds since begin_s(), by clock_now_s(); metres, radians, world frame.
/// - Threads: const members from many at once.
class SimulatedCell {
 public:
  /// Throws Error as link_capsules() does.
  explicit SimulatedCell(const SimulatedCellSettings& settings);

  /// Where the arm is: slow sines about a pose within its limits. q: one a joint.
  void joints_at(double time_s, std::span<double> q) const noexcept;
  /// Everything at an instant, the arm as simulation::Body::robot.
  [[nodiscard]] simulation::Scene scene_at(double time_s) const;
  /// The same as named bodies: what there is to be measured against.
  [[nodiscard]] simulation::Workcell bodies_at(double time_s) const;

  /// The clock's time at which the cell's is 0.
  [[nodiscard]] double begin_s() const noexcept { return begin_s_; }
  [[nodiscard]] std::size_t joints() const noexcept { return centre_.size(); }

 private:
  std::optional<robot::PlacedRobot> robot_;
  std::vector<robot::LinkCapsule> capsules_;
  std::vector<double> centre_;
  std::vector<double> swing_;
  std::optional<simulation::PersonScript> person_;
  simulation::Workcell room_;
  double begin_s_;
};

}  // namespace depthgrid::sensors
