// The head of a map file: what the map is, what it was made for and how large its tables are.
//
// clang-format off
//   offset  bytes
//        0      8  "DGRIDMAP"
//        8      4  0x01020304 as the writing machine stores it
//       12      4  version, 1
//       16      4  storage: 1 one pixel a cell, 2 full lists
//       20      4  count of calibration numbers
//       24      8  fingerprint of the calibration numbers
//       32      8  bytes of the head, a multiple of 64
//       40      8  bytes of the tables
//       48      8  cells in the tables
//       56      8  row spans in the tables; 0 with one pixel a cell
//       64      -  the calibration numbers, eight bytes each, in the order of numbers(); zeros up to the end of the head
// clang-format on
//
// The tables follow, then eight bytes: "DGRM" and the CRC-32 of everything before them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/grid/map/map_builder.hpp"
#include "depthgrid/grid/map/map_calibration.hpp"

namespace depthgrid::grid {

inline constexpr std::uint32_t kMapFileVersion = 1;

struct MapFileHeader {
  std::uint32_t version = kMapFileVersion;
  MapStorage storage = MapStorage::one_pixel;
  MapCalibration calibration;
  std::uint64_t fingerprint = 0;
  std::uint64_t header_bytes = 0;
  std::uint64_t table_bytes = 0;
  std::uint64_t cells = 0;
  std::uint64_t rows = 0;
  std::uint64_t file_bytes = 0;  ///< of the whole file
};

inline constexpr std::size_t kMapFileTrailerBytes = 8;
/// No head is longer.
[[nodiscard]] std::size_t largest_header_bytes() noexcept;

/// Fills in fingerprint and sizes from storage, calibration, cells and rows. Throws Error when they do not go together.
void complete(MapFileHeader& header);

[[nodiscard]] std::vector<std::byte> encode(const MapFileHeader& header);

/// Reads and checks a head from the first bytes of a file (all of them, or at least largest_header_bytes()) that has
/// `file_bytes` in all. Throws Error that names value and rule, not the file.
MapFileHeader decode_header(std::span<const std::byte> bytes, std::uint64_t file_bytes);

}  // namespace depthgrid::grid
