#include "lab/recordings/cameras.hpp"

#include <algorithm>

namespace depthgrid::lab {

Rig sub_rig(const Rig& rig, const CameraSet& cameras) {
  Rig result;
  result.name = rig.name;
  result.T_floor_world = rig.T_floor_world;
  for (const std::size_t k : cameras) {
    result.cameras.push_back(rig.cameras[k]);
  }
  return result;
}

std::vector<Frame> sub_frames(std::span<const Frame> frames, const CameraSet& cameras) {
  std::vector<Frame> result;
  for (const std::size_t k : cameras) {
    result.push_back(frames[k]);
  }
  return result;
}

std::vector<grid::SecondaryCamera> secondaries(const Rig& rig, const CameraSet& cameras) {
  std::vector<grid::SecondaryCamera> result;
  const Pose& T_world_principal = rig.cameras[cameras.front()].T_world_camera;
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[cameras[i]];
    result.push_back({camera.intrinsics, camera.T_world_camera.inverse() * T_world_principal});
  }
  return result;
}

std::vector<CameraSet> camera_sets(std::size_t camera_count, std::size_t principal) {
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < camera_count; ++k) {
    if (k != principal) {
      others.push_back(k);
    }
  }
  std::vector<CameraSet> sets;
  for (std::size_t mask = 0; mask < (std::size_t{1} << others.size()); ++mask) {
    CameraSet set{principal};
    for (std::size_t i = 0; i < others.size(); ++i) {
      if ((mask >> i & 1U) != 0) {
        set.push_back(others[i]);
      }
    }
    sets.push_back(set);
  }
  std::stable_sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return sets;
}

}  // namespace depthgrid::lab
