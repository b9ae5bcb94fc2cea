// A depth camera in the simulated cell, with its sensor's noise, range and holes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/sensors/simulated_cell.hpp"
#include "depthgrid/sensors/source.hpp"
#include "depthgrid/simulation/sensor_simulation.hpp"

namespace depthgrid::sensors {

/// Renders in next(), in the caller's thread; images that rendering comes too late for are passed over.
class SimulatedCamera final : public DepthSource {
 public:
  /// `camera`: of the sensor model RigCamera::sensor, empty: ideal. `unit` tells cameras of one model apart: noise, and
  /// the moment of the exposure within the period. Throws Error as SimulatedSensor does.
  SimulatedCamera(std::shared_ptr<const SimulatedCell> cell, const RigCamera& camera, double rate_hz,
                  std::uint64_t unit);

  void open() override;
  void close() noexcept override { is_open_ = false; }
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

 private:
  [[nodiscard]] double exposure_s(std::int64_t image) const noexcept;

  std::shared_ptr<const SimulatedCell> cell_;
  RigCamera camera_;
  double rate_hz_;
  double phase_s_;
  simulation::SimulatedSensor sensor_;
  DepthImage measured_m_;
  std::vector<std::uint16_t> units_;
  std::int64_t image_ = 0;  ///< the next one
  bool is_open_ = false;
  SourceInfo info_;
  std::string reason_;
};

}  // namespace depthgrid::sensors
