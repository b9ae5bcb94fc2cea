#include "lab/peers/edt_peer.hpp"
#include "lab/peers/fcl_peer.hpp"
#include "lab/peers/hull_peer.hpp"
#include "lab/peers/nanoflann_peer.hpp"
#include "lab/peers/pcl_peer.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {
namespace {

PeerKind nanoflann_kind(const char* name, const NanoflannSettings& settings) {
  return {name,  "k-d tree",
          false, false,
          8,     [settings](const PeerSetting& setting) { return std::make_unique<NanoflannPeer>(setting, settings); }};
}

PeerKind pcl_kind(const char* name, const PclSettings& settings) {
  return {name,  "k-d tree",
          false, false,
          8,     [settings](const PeerSetting& setting) { return std::make_unique<PclPeer>(setting, settings); }};
}

PeerKind edt_kind(const char* name, const EdtSettings& settings, int most_cameras) {
  return {name,
          "OctoMap",
          settings.unknown_is_occupied,
          true,
          most_cameras,
          [settings](const PeerSetting& setting) { return std::make_unique<EdtPeer>(setting, settings); }};
}

PeerKind fcl_kind(const char* name, double resolution_m, int most_cameras) {
  return {name,
          "OctoMap",
          false,
          true,
          most_cameras,
          [resolution_m](const PeerSetting& setting) { return std::make_unique<FclPeer>(setting, resolution_m); }};
}

PeerKind hull_kind(const char* name, double voxel_m) {
  return {name,  "convex hulls",
          false, false,
          8,     [voxel_m](const PeerSetting& setting) { return std::make_unique<HullPeer>(setting, voxel_m); }};
}

}  // namespace

std::vector<PeerKind> foreign_peers() {
  return {
      nanoflann_kind("nanoflann, full cloud", {Crop::full, 10, 0}),
      nanoflann_kind("nanoflann, cell", {Crop::cell, 10, 0}),
      nanoflann_kind("nanoflann, cell, leaf 32", {Crop::cell, 32, 0}),
      nanoflann_kind("nanoflann, cell, 1 cm voxels", {Crop::cell, 10, 0.01}),
      nanoflann_kind("nanoflann, arm box", {Crop::region, 10, 0}),
      pcl_kind("PCL KdTreeFLANN, full cloud", {Crop::full, 0}),
      pcl_kind("PCL KdTreeFLANN, cell", {Crop::cell, 0}),
      pcl_kind("PCL VoxelGrid 1 cm + KdTreeFLANN", {Crop::cell, 0.01}),
      hull_kind("PCL clusters, hulls + FCL", 0.02),
      edt_kind("OctoMap 5 cm + EDT", {0.05, History::kept, false}, 8),
      edt_kind("OctoMap 5 cm + EDT, unknown occupied", {0.05, History::fresh, true}, 8),
      edt_kind("OctoMap 2 cm + EDT", {0.02, History::kept, false}, 2),
      edt_kind("OctoMap 2 cm + EDT, unknown occupied", {0.02, History::fresh, true}, 2),
      fcl_kind("OctoMap 5 cm + FCL sphere", 0.05, 8),
      fcl_kind("OctoMap 2 cm + FCL sphere", 0.02, 2),
  };
}

}  // namespace depthgrid::lab
