// What moves in the cell of the avoidance experiments: nobody, a person by script or by record, a hand and a plate.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/simulation/mocap_clip.hpp"
#include "depthgrid/simulation/person_script.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::experiments {

inline constexpr double kHexagonRadius_m = 0.2;  ///< of the task, where a motion does not say otherwise

/// Solids in the world frame; always as many of each.
struct MovingSolids {
  std::vector<Capsule> capsules;
  std::vector<simulation::Box> boxes;
};

/// A function of time; never changes.
struct AvoidanceMotion {
  std::string name;                        ///< with the seed, where there is one
  std::function<MovingSolids(double)> at;  ///< seconds; empty: nothing moves
  double duration_s = 0;
  double v_max_m_s = 0;                        ///< no point of it moves faster
  std::vector<simulation::Box> plates{};       ///< stand there for this motion only
  double hexagon_radius_m = kHexagonRadius_m;  ///< of the task
};

/// Where the person's scripts play in the avoidance cell.
[[nodiscard]] simulation::PersonStage avoidance_stage(const Rig& rig);

[[nodiscard]] AvoidanceMotion nobody(double duration_s);
[[nodiscard]] AvoidanceMotion scripted_motion(simulation::Motion motion, const simulation::PersonStage& stage,
                                              std::uint64_t seed);

/// The clip turned about the vertical and shifted, so that the middle of its path passes within 0.2 ... 0.8 m of the
/// stage's place.
[[nodiscard]] AvoidanceMotion recorded_motion(const simulation::MocapClip& clip, const std::string& name,
                                              const simulation::PersonStage& stage, std::uint64_t seed);

/// A hand comes from the principal camera's side and from below, a large plate that this camera sees hangs on the other
/// side of the end effector, farther away. The task is a small hexagon.
[[nodiscard]] AvoidanceMotion hand_against_plate(const Eigen::Vector3d& end_effector_world);

/// At most `duration_s` of a motion, around the time when it is nearest to a point: time begins anew there.
[[nodiscard]] AvoidanceMotion nearest_part(const AvoidanceMotion& motion, const Eigen::Vector3d& p_world,
                                           double duration_s);

/// The nearest `duration_s` of the first person with a box, seeds from `first_seed` on, who walks through no camera.
/// Throws Error when the first hundred all do.
[[nodiscard]] AvoidanceMotion carrying_person(const Rig& rig, double duration_s, std::uint64_t first_seed);

/// Whether any of it comes within 0.35 m of a camera: people do not walk through cameras.
[[nodiscard]] bool meets_a_camera(const AvoidanceMotion& motion, const Rig& rig);

}  // namespace depthgrid::experiments
