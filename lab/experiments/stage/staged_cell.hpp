// The letter's room with the arm at work and a person who plays a script.
#pragma once

#include <cstddef>
#include <cstdint>

#include "depthgrid/simulation/person_script.hpp"
#include "depthgrid/simulation/workcell.hpp"
#include "lab/experiments/stage/arm_at_work.hpp"

namespace depthgrid::experiments {

/// Where the person's scripts play beside the arm at work: around its wrist.
[[nodiscard]] simulation::PersonStage stage_around_the_wrist();

/// A function of time, motion and seed alone. One thread.
class StagedCell {
 public:
  /// The motions with a box are refused with Error: their cell would need one body more.
  StagedCell(simulation::Motion motion, const simulation::PersonStage& stage, std::uint64_t seed);

  /// Takes everything to a time in seconds. The bodies of the cell are always the same.
  void move_to(double time_s);
  /// From now on nobody is there: what moves the person does nothing.
  void send_person_away();
  /// The arm stands, the person moves.
  void move_person_to(double time_s);

  [[nodiscard]] const simulation::Workcell& cell() const noexcept { return cell_; }
  [[nodiscard]] ArmAtWork& arm() noexcept { return arm_; }
  [[nodiscard]] const ArmAtWork& arm() const noexcept { return arm_; }
  [[nodiscard]] const simulation::PersonScript& person() const noexcept { return person_; }
  /// Indices in cell().bodies. The arm is one body.
  [[nodiscard]] std::size_t arm_body() const noexcept { return arm_body_; }
  [[nodiscard]] std::size_t person_body() const noexcept { return person_body_; }

  /// Where the arm's links are now goes into the cell. move_to() has done that.
  void take_arm();

 private:
  ArmAtWork arm_;
  simulation::PersonScript person_;
  simulation::Workcell cell_;
  std::size_t arm_body_;
  std::size_t person_body_;
  bool nobody_ = false;
};

}  // namespace depthgrid::experiments
