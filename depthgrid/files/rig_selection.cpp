#include "depthgrid/files/rig_selection.hpp"

#include <cstddef>
#include <set>

#include "depthgrid/core/error.hpp"

namespace depthgrid::files {
namespace {

std::size_t index_of(const Rig& rig, const std::string& id, const std::string& name) {
  try {
    return camera_index(rig, id);
  } catch (const Error& error) {
    fail_choice(name, ": ", error.what());
  }
}

}  // namespace

RigFile select_cameras(RigFile all, const std::vector<std::string>& ids, const std::string& name) {
  if (ids.empty()) {
    return all;
  }
  RigFile chosen = all;
  chosen.rig.cameras.clear();
  chosen.depth_files.clear();
  chosen.tracks.clear();
  std::set<std::string> seen;
  for (const std::string& id : ids) {
    if (!seen.insert(id).second) {
      fail_choice(name, ": camera '", id, "' is chosen twice");
    }
    const std::size_t k = index_of(all.rig, id, name);
    chosen.rig.cameras.push_back(all.rig.cameras[k]);
    chosen.depth_files.push_back(all.depth_files[k]);
    if (!all.tracks.empty()) {
      chosen.tracks.push_back(all.tracks[k]);
    }
  }
  return chosen;
}

}  // namespace depthgrid::files
