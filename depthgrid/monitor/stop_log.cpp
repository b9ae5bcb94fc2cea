#include "depthgrid/monitor/stop_log.hpp"

#include <array>
#include <cmath>
#include <ctime>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/short_text.hpp"
#include "depthgrid/monitor/monitor.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"

namespace depthgrid::monitor {
namespace {

constexpr std::size_t kTerms = 640;

std::string time_of_day(double time_s) {
  const messages::Time stamp = sensors::stamp_of(time_s);
  const std::time_t seconds = stamp.sec;
  std::tm utc{};
  std::array<char, 32> text{};
  (void)::gmtime_r(&seconds, &utc);
  std::string result(text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S.", &utc));
  constexpr std::uint32_t kMillisecond_ns = 1'000'000;
  const std::string part = std::to_string(stamp.nanosec / kMillisecond_ns);
  return result + std::string(3 - part.size(), '0') + part + "Z";
}

/// How far off the nearest point may have been measured: by the camera's readings and by its pose. NaN: no camera has,
/// or nobody knows from where.
double sensor_m(const Reason& reason, const StopLogSettings& settings) {
  const Rig& rig = settings.rig;
  const auto& camera = reason.nearest.camera;
  if (!camera || *camera >= rig.cameras.size() || !rig.cameras[*camera].margins) {
    return Proximity::kNaN;
  }
  if (*camera < settings.moves.size() && settings.moves[*camera]) {
    return Proximity::kNaN;
  }
  const RigCamera& of = rig.cameras[*camera];
  const Eigen::Vector3d seen = of.T_world_camera.inverse(Eigen::Isometry) * reason.nearest.nearest_world;
  return depth_margin_m(of.margins->sensor, seen.z()) + of.margins->translation_m +
         of.margins->rotation_rad * seen.norm();
}

}  // namespace

std::string stop_log_line(const Event& event, const StopLogSettings& settings) {
  const Reason& reason = event.reason;
  std::array<char, kTerms> buffer{};
  ShortText terms(buffer);
  terms.add(" | distance ").add(reason.distance_m, " m (").add(reason.nearest.distance_m, " m at the images' time)");
  terms.add("; human at most ").add(reason.v_max_m_s, " m/s; reaction ").add(reason.reaction_s, " s; stopping ");
  settings.stopping_s ? terms.add(*settings.stopping_s, " s") : terms.add("not stated, within the limit");
  terms.add("; robot ").add(reason.part_speed_m_s, " m/s, moved up to ");
  terms.add(reason.part_motion_m, " m since its joint state; sensor ");
  terms.add(sensor_m(reason, settings), " m; stops at ").add(reason.blind_m + reason.stop_m, " m: blind layer ");
  terms.add(reason.blind_m, " m + limit ").add(reason.stop_m, " m");
  return time_of_day(event.time_s) + " " + printable(event_line(event, settings.names)) + std::string(terms.text());
}

}  // namespace depthgrid::monitor
