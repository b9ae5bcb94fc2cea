#include "depthgrid/sensors/simulated_camera.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::sensors {

SimulatedCamera::SimulatedCamera(std::shared_ptr<const SimulatedCell> cell, const RigCamera& camera, double rate_hz,
                                 std::uint64_t unit)
    : cell_(std::move(cell)),
      camera_(camera),
      rate_hz_(rate_hz),
      // Any number that is not a simple fraction spreads the exposures over the period.
      phase_s_(std::fmod(0.618 * static_cast<double>(unit), 1.0) / rate_hz),
      sensor_(simulation::sensor_simulation(camera.sensor.empty() ? "ideal" : camera.sensor, camera.intrinsics),
              camera.intrinsics, unit + 1) {
  if (!(rate_hz > 0 && rate_hz <= 1000)) {
    fail("simulated camera ", camera.id, ": ", rate_hz, " images a second, must be above 0 and at most 1000");
  }
  info_ = {"simulated " + sensor_.sensor().name, std::to_string(unit), "this computer", camera_.intrinsics,
           camera_.metres_per_unit};
}

void SimulatedCamera::open() {
  is_open_ = true;
  reason_.clear();
  image_ = static_cast<std::int64_t>((clock_now_s() - cell_->begin_s()) * rate_hz_) + 1;
}

double SimulatedCamera::exposure_s(std::int64_t image) const noexcept {
  return cell_->begin_s() + phase_s_ + static_cast<double>(image) / rate_hz_;
}

Reading SimulatedCamera::next(DepthReading& reading, double longest_s) noexcept try {
  if (!is_open_) {
    reason_ = "is not open";
    return Reading::failed;
  }
  if (!wait_until(exposure_s(image_), longest_s)) {
    return Reading::nothing;
  }
  const double late_s = clock_now_s() - exposure_s(image_);
  reading.skipped = std::max<std::int64_t>(0, static_cast<std::int64_t>(late_s * rate_hz_));
  image_ += reading.skipped;
  reading.time_s = exposure_s(image_);
  const simulation::Scene scene = cell_->scene_at(reading.time_s - cell_->begin_s());
  sensor_.measure(scene.render(camera_.intrinsics, camera_.T_world_camera).depth_m, static_cast<std::uint64_t>(image_),
                  measured_m_);
  ++image_;
  units_ = simulation::in_units(measured_m_, camera_.metres_per_unit);
  reading.depth =
      depth_view(units_, camera_.intrinsics.width_px, camera_.intrinsics.height_px, camera_.metres_per_unit);
  reading.T_world_camera.reset();
  return Reading::got;
} catch (const std::exception& error) {
  reason_ = error.what();
  return Reading::failed;
}

}  // namespace depthgrid::sensors
