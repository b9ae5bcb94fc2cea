// Depth grid maps as files: versioned, checksummed, bound to their calibration, and loaded by memory map.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "depthgrid/grid/depth_grid_map.hpp"
#include "depthgrid/grid/map/map_file_header.hpp"

namespace depthgrid::grid {

/// Whether the checksum of the whole file is compared. Without it damage that leaves the tables well formed goes
/// unnoticed; the tables themselves are checked always, so that no file can lead a look-up out of memory.
enum class Checksum : bool { ignore, verify };

/// Writes a map; an existing file is replaced as a whole or not at all. Throws Error when the map is a closed form,
/// which has nothing to store, or the file cannot be written.
void save_map(const DepthGridMap& map, const std::string& path);

/// Loads a map. Its tables stay in the file's pages until the last copy of the map is gone; see MappedFile. Throws
/// Error that names file, value and rule when the file is cut off, damaged, of another version or byte order, or
/// malformed.
DepthGridMap load_map(const std::string& path, Checksum checksum = Checksum::verify);

/// As above, and refuses a map that was made for another calibration than this, before the tables are read.
DepthGridMap load_map(const std::string& path, const DepthGrid& grid, std::span<const SecondaryCamera> secondaries,
                      Checksum checksum = Checksum::verify);

/// Reads and checks the head only. Throws Error as load_map().
MapFileHeader read_map_info(const std::string& path);

/// A map in a file's bytes, which must begin at a multiple of 8; `owner` keeps them alive. Throws Error that names
/// value and rule.
DepthGridMap map_from_bytes(std::span<const std::byte> bytes, std::shared_ptr<const void> owner,
                            Checksum checksum = Checksum::verify);

}  // namespace depthgrid::grid
