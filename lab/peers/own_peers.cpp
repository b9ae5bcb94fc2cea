#include "lab/peers/bubble_peer.hpp"
#include "lab/peers/cloud_scan_peer.hpp"
#include "lab/peers/grid_peer.hpp"
#include "lab/peers/lattice_peer.hpp"
#include "lab/peers/peer.hpp"
#include "lab/peers/search_peer.hpp"
#include "lab/peers/window_scan_peer.hpp"

namespace depthgrid::lab {
namespace {

PeerKind cloud_scan(const char* name, Crop crop) {
  return {name,  "scan of the cloud",
          false, false,
          8,     [crop](const PeerSetting& setting) { return std::make_unique<CloudScanPeer>(setting, crop); }};
}

PeerKind window_scan(const char* name, WindowScanPeer::Combine combine, bool carves) {
  return {name, "scan of the image",
          true, carves,
          8,    [combine](const PeerSetting& setting) { return std::make_unique<WindowScanPeer>(setting, combine); }};
}

PeerKind lattice(const char* name, double pitch_m) {
  return {name, "lattice",
          true, true,
          8,    [pitch_m](const PeerSetting& setting) { return std::make_unique<LatticePeer>(setting, pitch_m); }};
}

PeerKind grid_kind(const char* name, grid::Variant variant, grid::Collect collect) {
  return {name,
          variant == grid::Variant::letter ? "letter" : "corrected",
          true,
          true,
          8,
          [variant, collect](const PeerSetting& setting) {
            return std::make_unique<GridPeer>(setting, variant, collect); }};
}

PeerKind ours(const char* name, int lateral_px) {
  return {name, "search", true, true, 8, [lateral_px](PeerSetting setting) {
            setting.sensor.lateral_px = lateral_px;
            return std::make_unique<SearchPeer>(setting, 0.005);
          }};
}

PeerKind bubbles(const char* name) {
  return {name,  "people by a tracker",
          false, false,
          8,     [](const PeerSetting& setting) { return std::make_unique<BubblePeer>(setting); }};
}

}  // namespace

std::vector<PeerKind> own_peers() {
  using Combine = WindowScanPeer::Combine;
  return {
      ours("search", 1),
      ours("search, w = 0", 0),
      grid_kind("letter, hybrid", grid::Variant::letter, grid::Collect::hybrid),
      grid_kind("letter, minimum", grid::Variant::letter, grid::Collect::minimum),
      grid_kind("corrected, hybrid", grid::Variant::corrected, grid::Collect::hybrid),
      grid_kind("corrected, minimum", grid::Variant::corrected, grid::Collect::minimum),
      lattice("lattice 20 mm", 0.02),
      lattice("lattice 10 mm", 0.01),
      window_scan("scan of one camera's window", Combine::first, false),
      window_scan("minimum of the cameras' scans", Combine::minimum, false),
      window_scan("maximum of the cameras' scans", Combine::maximum, true),
      cloud_scan("scan of the full cloud", Crop::full),
      cloud_scan("scan of the cell's cloud", Crop::cell),
      cloud_scan("scan of the arm box's cloud", Crop::region),
      bubbles("bubbles around people"),
  };
}

}  // namespace depthgrid::lab
