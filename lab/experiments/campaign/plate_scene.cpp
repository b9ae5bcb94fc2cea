#include "lab/experiments/campaign/plate_scene.hpp"

#include <algorithm>

#include "depthgrid/robot/kuka_lwr4.hpp"

namespace depthgrid::experiments {

PlateScene plate_scene(Method method, const AvoidanceSettings& settings) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const AvoidanceMotion motion = hand_against_plate(hexagon_centre_world(model));
  RunSettings run;
  run.common = settings;
  run.duration_s = motion.duration_s;
  run.sample_every = 10;
  const RunResult result = run_avoidance(method, model, motion, run);
  PlateScene scene;
  scene.smallest_m = result.summary.smallest_person_m;
  scene.contacts = static_cast<int>(result.summary.contacts.size());
  for (const RunSample& sample : result.samples) {
    const MovingSolids hand = motion.at(sample.time_s);
    Eigen::Vector3d way = nearest_on_axis(hand.capsules[0], sample.end_effector_world) - sample.end_effector_world;
    for (const Capsule& capsule : hand.capsules) {
      const Eigen::Vector3d other = nearest_on_axis(capsule, sample.end_effector_world) - sample.end_effector_world;
      way = other.norm() < way.norm() ? other : way;
    }
    const double to_hand_m_s = sample.repulsion_m_s.dot(way.normalized());
    const double to_nearest_m_s = sample.repulsion_m_s.dot(sample.to_nearest);
    scene.time_s.push_back(sample.time_s);
    scene.hand_m.push_back(sample.true_person_m);
    scene.towards_nearest_m_s.push_back(to_nearest_m_s);
    scene.fastest_towards_nearest_m_s = std::max(scene.fastest_towards_nearest_m_s, to_nearest_m_s);
    if (way.norm() - hand.capsules[0].radius_m < 0.5 * settings.rho_m) {
      scene.fastest_towards_hand_m_s = std::max(scene.fastest_towards_hand_m_s, to_hand_m_s);
    }
  }
  return scene;
}

}  // namespace depthgrid::experiments
