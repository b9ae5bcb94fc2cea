// The joints of the simulated cell's arm.
#pragma once

#include <memory>
#include <vector>

#include "depthgrid/sensors/simulated_cell.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

class SimulatedJoints final : public JointSource {
 public:
  /// Throws Error when the cell has no robot, or the rate is not above 0 and at most 10000.
  SimulatedJoints(std::shared_ptr<const SimulatedCell> cell, double rate_hz);

  void open() override;
  void close() noexcept override { is_open_ = false; }
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return is_open_ ? "" : "is not open"; }
  [[nodiscard]] Reading next(JointReading& reading, double longest_s) noexcept override;

 private:
  std::shared_ptr<const SimulatedCell> cell_;
  double rate_hz_;
  double next_s_ = 0;
  bool is_open_ = false;
  std::vector<double> q_;
  SourceInfo info_;
};

}  // namespace depthgrid::sensors
