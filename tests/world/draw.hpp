// The parts of a random world. Internal to make_world().
#pragma once

#include "world/random.hpp"
#include "world/world.hpp"

namespace depthgrid::world {

/// Cameras, their images and margins; the space of interest is set already, and the fastest obstacle.
void draw_cameras(World& world);
/// The robot, what stands around and what moves. Cameras are there.
void draw_robot(World& world);
void draw_solids(World& world);
/// When the cameras expose, and which images arrive when.
void draw_exposures(World& world);
/// Last: what is declared about the start has to be true.
void draw_memory(World& world);

/// Random stops in the box, or some of them beside `targets`, never faster than speed_m_s.
[[nodiscard]] std::shared_ptr<const Path> random_path(Random& random, const Eigen::Vector3d& low,
                                                      const Eigen::Vector3d& high, double speed_m_s, double duration_s,
                                                      const std::vector<Eigen::Vector3d>& targets);
[[nodiscard]] std::shared_ptr<const Path> standing(const Eigen::Vector3d& at_world);

/// A dozen capsules that walk and swing their limbs; no point of it is faster than speed_m_s.
[[nodiscard]] std::vector<Solid> random_person(Random& random, std::shared_ptr<const Path> feet, double path_speed_m_s,
                                               double speed_m_s, double least_radius_m);

/// How fast things really are.
[[nodiscard]] double true_speed_m_s(const World& world);
/// No thing is thinner than twice this, so that a camera's rays meet it wherever it is in W.
[[nodiscard]] double least_radius_m(const World& world);

}  // namespace depthgrid::world
