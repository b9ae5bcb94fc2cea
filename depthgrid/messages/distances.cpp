#include "depthgrid/messages/distances.hpp"

namespace depthgrid::messages {
namespace {

Point point_of(const Eigen::Vector3d& p) { return {.x = p.x(), .y = p.y(), .z = p.z()}; }

}  // namespace

Distance distance_of(const Answer& answer, std::string_view id, std::string_view camera, std::string_view reason) {
  const Proximity& nearest = answer.nearest;
  Distance distance;
  distance.id = id;
  distance.distance = nearest.distance_m;
  distance.distance_now = answer.distance_now_m;
  distance.state = static_cast<std::uint8_t>(nearest.state);
  distance.reason = reason;
  distance.nearest = point_of(nearest.nearest_world);
  distance.direction = {
      .x = nearest.direction_world.x(), .y = nearest.direction_world.y(), .z = nearest.direction_world.z()};
  distance.on_axis = point_of(answer.on_axis_world);
  distance.camera = camera;
  distance.known_to = nearest.known_to_m;
  distance.blind = answer.blind_m;
  distance.stale = nearest.stale;
  distance.budget = nearest.budget;
  return distance;
}

}  // namespace depthgrid::messages
