#include "depthgrid/grid/map/map_file_header.hpp"

#include <array>
#include <cstring>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/map/one_pixel_map.hpp"
#include "depthgrid/grid/map/pixel_list_map.hpp"

namespace depthgrid::grid {
namespace {

constexpr std::array<char, 8> kMagic{'D', 'G', 'R', 'I', 'D', 'M', 'A', 'P'};
constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr std::uint32_t kOtherByteOrder = 0x04030201;
constexpr std::uint64_t kAlignment = 64;
/// Far more than any disk holds, and small enough that no sum of sizes overflows.
constexpr std::uint64_t kLargestTableCount = std::uint64_t{1} << 56U;

struct FixedPart {
  std::array<char, 8> magic;
  std::uint32_t byte_order;
  std::uint32_t version;
  std::uint32_t storage;
  std::uint32_t number_count;
  std::uint64_t fingerprint;
  std::uint64_t header_bytes;
  std::uint64_t table_bytes;
  std::uint64_t cells;
  std::uint64_t rows;
};
static_assert(sizeof(FixedPart) == 64, "the layout is the file's");

std::uint64_t header_bytes_for(std::uint64_t number_count) noexcept {
  const std::uint64_t used = sizeof(FixedPart) + number_count * sizeof(double);
  return (used + kAlignment - 1) / kAlignment * kAlignment;
}

std::uint64_t table_bytes_for(const MapFileHeader& header) {
  const std::uint64_t cameras = header.calibration.secondaries.size();
  const std::uint64_t all_cells = cell_count(header.calibration) * cameras;
  if (header.storage == MapStorage::one_pixel) {
    if (header.cells != all_cells || header.rows != 0) {
      fail("head names ", header.cells, " cells and ", header.rows, " row spans, one pixel a cell needs ", all_cells,
           " and 0");
    }
    return all_cells * sizeof(OnePixelMap::Cell);
  }
  if (header.cells > all_cells || header.rows > kLargestTableCount) {
    fail("head names ", header.cells, " cells and ", header.rows, " row spans, full lists have at most ", all_cells,
         " and ", kLargestTableCount);
  }
  return ray_count(header.calibration) * cameras * sizeof(PixelListMap::RayHeader) +
         header.cells * sizeof(PixelListMap::Cell) + header.rows * sizeof(PixelListMap::RowSpan);
}

}  // namespace

std::size_t largest_header_bytes() noexcept { return header_bytes_for(number_count(kLargestCameraCount)); }

void complete(MapFileHeader& header) {
  header.fingerprint = fingerprint(header.calibration);
  header.header_bytes = header_bytes_for(number_count(header.calibration.secondaries.size()));
  header.table_bytes = table_bytes_for(header);
  header.file_bytes = header.header_bytes + header.table_bytes + kMapFileTrailerBytes;
}

std::vector<std::byte> encode(const MapFileHeader& header) {
  const std::vector<CalibrationNumber> values = numbers(header.calibration);
  const FixedPart fixed{kMagic,
                        kByteOrder,
                        header.version,
                        header.storage == MapStorage::one_pixel ? 1U : 2U,
                        static_cast<std::uint32_t>(values.size()),
                        header.fingerprint,
                        header.header_bytes,
                        header.table_bytes,
                        header.cells,
                        header.rows};
  std::vector<std::byte> bytes(header.header_bytes);
  std::memcpy(bytes.data(), &fixed, sizeof fixed);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::memcpy(bytes.data() + sizeof fixed + i * sizeof(double), &values[i].value, sizeof(double));
  }
  return bytes;
}

MapFileHeader decode_header(std::span<const std::byte> bytes, std::uint64_t file_bytes) {
  FixedPart fixed{};
  if (bytes.size() < sizeof fixed) {
    fail("has ", file_bytes, " bytes, a map file has at least ", sizeof fixed, "; is it cut off?");
  }
  std::memcpy(&fixed, bytes.data(), sizeof fixed);
  if (fixed.magic != kMagic) {
    fail("does not begin with DGRIDMAP: not a depth grid map");
  }
  if (fixed.byte_order == kOtherByteOrder) {
    fail("was written by a machine of the other byte order; build the map on this one");
  }
  if (fixed.byte_order != kByteOrder) {
    fail("byte-order mark is ", fixed.byte_order, ", must be ", kByteOrder);
  }
  if (fixed.version != kMapFileVersion) {
    fail("has version ", fixed.version, ", this program reads version ", kMapFileVersion, "; build the map again");
  }
  if (fixed.storage != 1 && fixed.storage != 2) {
    fail("storage is ", fixed.storage, ", must be 1 (one pixel a cell) or 2 (full lists)");
  }
  if (fixed.number_count == 0 || fixed.number_count > number_count(kLargestCameraCount)) {
    fail("has ", fixed.number_count, " calibration numbers, must be between 1 and ", number_count(kLargestCameraCount));
  }
  if (fixed.header_bytes != header_bytes_for(fixed.number_count)) {
    fail("head has ", fixed.header_bytes, " bytes, must have ", header_bytes_for(fixed.number_count), " for ",
         fixed.number_count, " calibration numbers");
  }
  if (fixed.header_bytes > bytes.size()) {
    fail("has ", file_bytes, " bytes, its head alone has ", fixed.header_bytes, "; is it cut off?");
  }
  std::vector<double> values(fixed.number_count);
  std::memcpy(values.data(), bytes.data() + sizeof fixed, values.size() * sizeof(double));

  MapFileHeader header;
  header.storage = fixed.storage == 1 ? MapStorage::one_pixel : MapStorage::pixel_lists;
  header.calibration = calibration_from_numbers(values, "calibration");
  header.cells = fixed.cells;
  header.rows = fixed.rows;
  complete(header);
  if (fixed.fingerprint != header.fingerprint) {
    fail("fingerprint is ", fixed.fingerprint, ", its calibration numbers have ", header.fingerprint,
         "; is it damaged?");
  }
  if (fixed.table_bytes != header.table_bytes) {
    fail("head names ", fixed.table_bytes, " bytes of tables, its counts make ", header.table_bytes);
  }
  if (file_bytes != header.file_bytes) {
    fail("has ", file_bytes, " bytes, its head asks for ", header.file_bytes,
         file_bytes < header.file_bytes ? "; is it cut off?" : "; something was added");
  }
  return header;
}

}  // namespace depthgrid::grid
