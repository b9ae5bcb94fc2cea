// Builds stored depth grid maps, off line, on all cores.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/depth_grid_map.hpp"

namespace depthgrid::grid {

enum class MapStorage : std::uint8_t {
  closed_form,  ///< computes the relation, needs no memory
  one_pixel,    ///< the pixel of the cell's centre: eight bytes a cell and secondary camera
  pixel_lists,  ///< all pixels that the cell projects on
};

/// Memory that a map takes while it is built and afterwards.
struct MapMemory {
  std::uint64_t bytes = 0;
  /// 1: exact. Otherwise bytes is what a sample of the rays asks for times this factor.
  double safety_factor = 1.0;
};

/// One pixel a cell: exact. Full lists: from about a thousand rays for each camera, times 1.25 (exact for images of
/// fewer rays). Throws Error when a camera is invalid.
[[nodiscard]] MapMemory estimate_map_memory(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries,
                                            MapStorage storage);

struct MapBuildProgress {
  std::int64_t done = 0;               ///< rows of rays; full lists visit each row twice: to count and to write
  std::int64_t total = 0;              ///< never changes while building
  std::optional<double> seconds_left;  ///< at the pace so far; nothing before the first row
};

struct MapBuildSettings {
  int threads = 0;  ///< 0: one a core. The map does not depend on it.
  /// A map that needs more is refused. Nothing: available_memory_bytes().
  std::optional<std::uint64_t> memory_limit_bytes;
  /// Called on the thread that builds, about ten times a second; false cancels. May be empty.
  std::function<bool(const MapBuildProgress&)> progress;
};

/// Thrown when `progress` asked to stop.
class MapBuildCancelled : public Error {
 public:
  using Error::Error;
};

/// Builds a map. Throws Error when a camera is invalid or the map would not fit into the memory limit (before anything
/// is allocated), MapBuildCancelled when `progress` returned false. What `progress` throws is passed on.
DepthGridMap build_map(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries, MapStorage storage,
                       const MapBuildSettings& settings = {});
OnePixelMap build_one_pixel_map(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries,
                                const MapBuildSettings& settings = {});
PixelListMap build_pixel_list_map(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries,
                                  const MapBuildSettings& settings = {});

/// Bytes of a map's tables; 0 for the closed form.
[[nodiscard]] std::uint64_t table_bytes(const DepthGridMap& map) noexcept;

}  // namespace depthgrid::grid
