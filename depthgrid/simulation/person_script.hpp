// A person who moves through the workcell by a script: a function of time, motion, stage and seed alone.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "depthgrid/simulation/person_body.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::simulation {

enum class Motion : std::uint8_t {
  walk_in,            ///< comes in, stands beside the robot, walks on and leaves
  reach,              ///< comes in, reaches for the robot, holds, leaves
  carry_box,          ///< the same with a box in both hands
  hand_behind_robot,  ///< the hand is where the robot hides it from the camera
  arm_between,        ///< an arm far from the robot, on the line from the camera to it
};
[[nodiscard]] std::span<const Motion> motions() noexcept;
[[nodiscard]] std::string_view to_string(Motion motion) noexcept;

/// Where a script plays. World frame, metres, z up.
struct PersonStage {
  Eigen::Vector3d robot_world{0.0, 0.0, 0.6};      ///< the place on the robot that it is about
  Eigen::Vector3d camera_world{-2.0, -0.18, 0.5};  ///< for hand_behind_robot and arm_between
  double floor_m = -0.5;
  double entrance_m = 2.6;  ///< from the robot to where the person comes in, horizontally
  double v_max_m_s = 2.0;   ///< nothing of the person, nor of what is carried, moves faster
};

struct PersonState {
  std::array<Capsule, 17> parts_world;
  std::optional<Box> carried_world;
};

/// A pose that a script passes at rest, and how it gets there.
struct PersonKey {
  PersonConfiguration configuration;
  double hold_s = 0;  ///< stands still here afterwards
};

/// Const members may be called from many threads at once.
class PersonScript {
 public:
  /// The seed decides where the person comes in, how fast it is (0.6 to 1 of v_max), where exactly it reaches, how long
  /// it stays. Throws Error unless all numbers are finite, v_max is positive and the entrance at least 1.5 m away.
  PersonScript(Motion motion, const PersonStage& stage, std::uint64_t seed);

  /// Before 0 as at 0, after duration_s() as then; continuous. No end of a capsule's axis and no corner of the box
  /// moves by more than v_max_m_s() times the time, and so no point of the surfaces does, each taken as a set.
  [[nodiscard]] PersonState at(double time_s) const noexcept;

  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  [[nodiscard]] double v_max_m_s() const noexcept { return v_max_m_s_; }
  [[nodiscard]] Motion motion() const noexcept { return motion_; }

 private:
  /// From one key to the next: at `share` of the way, 0 to 1.
  struct Segment {
    PersonConfiguration from;
    PersonConfiguration to;
    double start_s = 0;
    double moving_s = 0;
  };
  [[nodiscard]] static PersonConfiguration between(const Segment& segment, double share) noexcept;
  [[nodiscard]] PersonState state(const PersonConfiguration& configuration) const noexcept;
  [[nodiscard]] double least_duration_s(const Segment& segment, double speed_m_s) const noexcept;

  Motion motion_;
  double v_max_m_s_;
  double duration_s_ = 0;
  std::vector<Segment> segments_;
};

}  // namespace depthgrid::simulation
