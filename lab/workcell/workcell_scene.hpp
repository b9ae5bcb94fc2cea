// The workcell that the simulation's programs show and measure: the letter's room, an arm at work and a person.
#pragma once

#include <cstdint>

#include "depthgrid/simulation/figures.hpp"
#include "depthgrid/simulation/person_script.hpp"
#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::lab {

/// What the arm is made of.
enum class ArmShape : std::uint8_t { capsules, meshes };

/// A seven-link arm on the pedestal turns its joints; a person plays a script. Everything is a function of time.
class WorkcellScene {
 public:
  /// `mesh_segments` of each link's mesh around its axis.
  WorkcellScene(simulation::Motion motion, std::uint64_t seed, ArmShape shape, int mesh_segments = 32);

  /// The cell at a time; always the same bodies.
  [[nodiscard]] const simulation::Workcell& at(double time_s);

  [[nodiscard]] const simulation::PersonScript& person() const noexcept { return person_; }
  [[nodiscard]] static simulation::PersonStage stage();
  [[nodiscard]] static simulation::Arm arm_at(double time_s) noexcept;

 private:
  simulation::PersonScript person_;
  simulation::Workcell cell_;
  std::vector<std::size_t> link_bodies_;
  std::size_t person_body_ = 0;
  std::optional<std::size_t> box_body_;
};

}  // namespace depthgrid::lab
