// The arm stands in full view of two cameras, and a ball stands near its last link.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"
#include "depthgrid/views/settings.hpp"
#include "lab/experiments/stage/arm_at_work.hpp"
#include "lab/workcell/depth_caster.hpp"

namespace depthgrid::experiments {

inline constexpr double kHandRadius_m = 0.05;  ///< of the ball that plays a hand

enum class HandPlace : std::uint8_t {
  beside,  ///< across the line of sight of both cameras, so that both see ball and link beside each other
  before,  ///< between the first camera and the link
};

/// Images of one instant. One thread.
class HandBeside {
 public:
  /// Throws Error as DepthCaster and SimulatedSensors do. `rig`: the letter's two cameras.
  HandBeside(const Rig& rig, std::uint64_t seed);

  /// The ball so far from the last link's surface; without a distance it lies in a corner of the room. `frame` numbers
  /// the noise.
  void take(HandPlace place, std::optional<double> gap_m, std::uint64_t frame = 0);

  [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
  [[nodiscard]] const ArmAtWork& arm() const noexcept { return arm_; }
  /// The last link, world frame.
  [[nodiscard]] const Capsule& link_world() const noexcept { return arm_.capsules_world().back(); }
  [[nodiscard]] Eigen::Vector3d hand_world() const { return cell_.bodies[hand_].spheres.front().centre_world; }
  /// Of a ball at this place: from the link's axis.
  [[nodiscard]] Eigen::Vector3d direction_world(HandPlace place) const;

  [[nodiscard]] const simulation::Workcell& cell() const noexcept { return cell_; }
  [[nodiscard]] std::size_t hand_body() const noexcept { return hand_; }
  /// One a camera, of the last take().
  [[nodiscard]] const DepthImage& depth_m(std::size_t camera) const { return measured_m_[camera]; }
  [[nodiscard]] bool shows_hand(std::size_t camera, std::size_t pixel) const {
    return bodies_[camera].body[pixel] == hand_;
  }

 private:
  Rig rig_;
  ArmAtWork arm_;
  simulation::Workcell cell_;
  std::size_t hand_;
  std::optional<workcell::DepthCaster> caster_;
  simulation::SimulatedSensors sensors_;
  std::vector<DepthImage> ideal_m_;
  std::vector<DepthImage> measured_m_;
  std::vector<workcell::BodyImage> bodies_;
};

/// The search's settings for it: what nobody looks at and what is behind the robot is an obstacle, up to rho.
[[nodiscard]] views::Settings hand_settings(const Rig& rig);

/// The search with what is declared for the sensors and a memory that begins with nothing known, asked about links
/// after some images at 30 Hz of a scene that stands; the sensor's margin is in the test.
class RememberedScene {
 public:
  /// The scene must outlive it. Throws Error as the evaluator does.
  RememberedScene(HandBeside& scene, double padding_m);

  /// Further images with the ball there.
  void see(HandPlace place, std::optional<double> gap_m, int images);
  /// Of a capsule at the time of the newest images.
  [[nodiscard]] Answer distance(const Capsule& capsule_world);

 private:
  HandBeside& scene_;
  Rig rig_;
  search::SearchEvaluator evaluator_;
  std::vector<robot::RobotRemoval> removals_;
  std::uint64_t images_ = 0;
};

/// What the search answers for the last link with the arm removed with this padding.
[[nodiscard]] Answer removed_answer(const HandBeside& scene, double padding_m);

}  // namespace depthgrid::experiments
