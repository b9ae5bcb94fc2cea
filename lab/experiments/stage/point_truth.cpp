#include "lab/experiments/stage/point_truth.hpp"

#include <string>

#include "depthgrid/core/error.hpp"

namespace depthgrid::experiments {

using simulation::BodyKind;

namespace {

constexpr double kProbeRadius = 1e-3;  ///< of the ball that stands for a point, metres; added to its distance

/// Nothing but the probes is of kind robot, so that they see each other never and everything else always.
simulation::Workcell with_probes(const simulation::Workcell& cell, std::size_t points) {
  simulation::Workcell probed;
  for (const simulation::WorkcellBody& body : cell.bodies) {
    if (body.kind != BodyKind::robot) {
      probed.bodies.push_back(body);
    }
  }
  for (std::size_t i = 0; i < points; ++i) {
    simulation::WorkcellBody probe;
    probe.name = "probe " + std::to_string(i + 1);
    probe.kind = BodyKind::robot;
    probe.spheres.push_back({Eigen::Vector3d::Zero(), kProbeRadius});
    probed.bodies.push_back(std::move(probe));
  }
  return probed;
}

}  // namespace

PointTruth::PointTruth(const simulation::Workcell& cell, std::size_t points)
    : probed_(with_probes(cell, points)), points_(points), truth_(probed_) {}

void PointTruth::take(const simulation::Workcell& cell, std::span<const Eigen::Vector3d> points_world) {
  std::size_t next = 0;
  for (const simulation::WorkcellBody& body : cell.bodies) {
    if (body.kind != BodyKind::robot) {
      probed_.bodies[next++] = body;
    }
  }
  for (const Eigen::Vector3d& p_world : points_world) {
    probed_.bodies[next++].spheres.front().centre_world = p_world;
  }
}

std::vector<PointTruth::Nearest> PointTruth::distances(const simulation::Workcell& cell,
                                                       std::span<const Eigen::Vector3d> points_world) {
  if (points_world.size() != points_) {
    fail("truth of ", points_world.size(), " points, made for ", points_);
  }
  take(cell, points_world);
  truth_.update(probed_);
  std::vector<Nearest> result;
  const std::size_t first = probed_.bodies.size() - points_;
  for (std::size_t i = 0; i < points_; ++i) {
    const auto found = truth_.nearest(first + i, {BodyKind::room, BodyKind::object, BodyKind::person});
    if (!found) {
      fail("truth of a cell with nothing but the robot in it");
    }
    const std::size_t other = found->first == first + i ? found->second : found->first;
    // Overlapping bodies are at distance 0: within a millimetre of a surface the ball says no more than that.
    result.push_back({found->distance_m > 0 ? found->distance_m + kProbeRadius : 0.0, probed_.bodies[other].kind});
  }
  return result;
}

}  // namespace depthgrid::experiments
