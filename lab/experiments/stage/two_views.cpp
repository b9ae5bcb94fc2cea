#include "lab/experiments/stage/two_views.hpp"

namespace depthgrid::experiments {

simulation::Arrangement two_views(std::string_view sensor) {
  simulation::Arrangement arrangement = simulation::letter_arrangement(sensor);
  arrangement.rig.name = "the letter's first camera, one opposite and one aside";
  RigCamera aside = arrangement.rig.cameras.back();
  aside.id = "camera 2 aside";
  aside.T_world_camera = look_at({1.15, 2.2, 1.1}, {0, 0, 0.4});
  arrangement.rig.cameras.push_back(aside);
  return arrangement;
}

}  // namespace depthgrid::experiments
