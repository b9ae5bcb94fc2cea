#include "memory/random_play.hpp"

#include <cmath>

namespace depthgrid::memory {

RandomPlay::RandomPlay(reference::Random& random)
    : cell(random),
      views(cell.rig, cell.settings),
      store(views, cell.memory),
      twin(views.settings(), cell.memory, store.snapshot().voxels()),
      time_s_(random.uniform(0, 100)) {}

bool RandomPlay::next(reference::Random& random, const Gaps& gaps) {
  camera_ = static_cast<std::size_t>(random.integer(0, static_cast<int>(cell.rig.cameras.size()) - 1));
  time_s_ +=
      random.chance(0.2) ? -random.uniform(0, 0.02) : std::exp(random.uniform(gaps.shortest_log, gaps.longest_log));
  ++images_;
  const RandomImage image(cell, camera_, time_s_, random);
  if (!views.update(camera_, image.frame(), image.T_world_camera()).taken()) {
    return false;
  }
  store.take(camera_);
  const MemorySnapshot memory = store.snapshot();
  twin.take(views.snapshot(), camera_, memory.voxels());
  return true;
}

std::string RandomPlay::text() const {
  return "image " + std::to_string(images_) + " of camera " + std::to_string(camera_) + " at " +
         std::to_string(time_s_) + " s";
}

}  // namespace depthgrid::memory
