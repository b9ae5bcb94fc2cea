#include "depthgrid/grid/map/map_file.hpp"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/map/mapped_file.hpp"

namespace depthgrid::grid {
namespace {

using Bytes = std::span<const std::byte>;

struct Trailer {
  std::array<char, 4> mark{'D', 'G', 'R', 'M'};
  std::uint32_t crc32 = 0;
};
static_assert(sizeof(Trailer) == kMapFileTrailerBytes, "the layout is the file's");

std::uint32_t add_crc32(std::uint32_t crc, Bytes bytes) noexcept {
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class T>
std::span<const T> take(Bytes& bytes, std::uint64_t count) noexcept {
  const std::span<const T> table(reinterpret_cast<const T*>(bytes.data()), count);
  bytes = bytes.subspan(table.size_bytes());
  return table;
}

void verify_trailer(Bytes bytes, Checksum checksum) {
  Trailer trailer;
  std::memcpy(&trailer, bytes.last(sizeof trailer).data(), sizeof trailer);
  if (trailer.mark != Trailer().mark) {
    fail("does not end with DGRM before its checksum; is it damaged?");
  }
  if (checksum == Checksum::verify) {
    const std::uint32_t actual = add_crc32(0, bytes.first(bytes.size() - sizeof trailer));
    if (actual != trailer.crc32) {
      fail("checksum is ", trailer.crc32, ", its content has ", actual, "; is it damaged?");
    }
  }
}

// Runs `read` so that its errors name the file.
template <class Read>
auto naming(const std::string& path, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    fail("map file '", path, "': ", error.what());
  }
}

DepthGridMap load(const std::string& path, const MapCalibration* wanted, Checksum checksum) {
  const std::shared_ptr<const MappedFile> file = MappedFile::open(path);
  return naming(path, [&]() -> DepthGridMap {
    if (wanted != nullptr) {
      const MapFileHeader header = decode_header(file->bytes(), file->bytes().size());
      const std::string mismatch = difference(header.calibration, *wanted);
      if (!mismatch.empty()) {
        fail("was made for another calibration: ", mismatch, "; build it again");
      }
    }
    return map_from_bytes(file->bytes(), file, checksum);
  });
}

}  // namespace

DepthGridMap map_from_bytes(Bytes bytes, std::shared_ptr<const void> owner, Checksum checksum) {
  if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(std::uint64_t) != 0) {
    fail("depth grid map: bytes must begin at an address that is a multiple of ", alignof(std::uint64_t));
  }
  MapFileHeader header = decode_header(bytes, bytes.size());
  verify_trailer(bytes, checksum);
  Bytes tables = bytes.subspan(header.header_bytes);
  if (header.storage == MapStorage::one_pixel) {
    return OnePixelMap(std::move(header.calibration), take<OnePixelMap::Cell>(tables, header.cells), std::move(owner));
  }
  const std::uint64_t rays = ray_count(header.calibration) * header.calibration.secondaries.size();
  PixelListMap::Tables lists;
  lists.rays = take<PixelListMap::RayHeader>(tables, rays);
  lists.cells = take<PixelListMap::Cell>(tables, header.cells);
  lists.rows = take<PixelListMap::RowSpan>(tables, header.rows);
  return PixelListMap(std::move(header.calibration), lists, std::move(owner));
}

void save_map(const DepthGridMap& map, const std::string& path) {
  MapFileHeader header;
  std::vector<Bytes> parts(1);
  if (const auto* one_pixel = std::get_if<OnePixelMap>(&map)) {
    header.storage = MapStorage::one_pixel;
    header.calibration = one_pixel->calibration();
    header.cells = one_pixel->cells().size();
    parts.push_back(std::as_bytes(one_pixel->cells()));
  } else if (const auto* lists = std::get_if<PixelListMap>(&map)) {
    header.storage = MapStorage::pixel_lists;
    header.calibration = lists->calibration();
    header.cells = lists->tables().cells.size();
    header.rows = lists->tables().rows.size();
    parts.push_back(std::as_bytes(lists->tables().rays));
    parts.push_back(std::as_bytes(lists->tables().cells));
    parts.push_back(std::as_bytes(lists->tables().rows));
  } else {
    fail("map file '", path, "': the closed form has nothing to store; build one-pixel or lists");
  }
  complete(header);
  const std::vector<std::byte> head = encode(header);
  parts.front() = head;
  Trailer trailer;
  for (const Bytes& part : parts) {
    trailer.crc32 = add_crc32(trailer.crc32, part);
  }
  parts.push_back(std::as_bytes(std::span(&trailer, 1)));
  write_file_whole(path, parts);
}

DepthGridMap load_map(const std::string& path, Checksum checksum) { return load(path, nullptr, checksum); }

DepthGridMap load_map(const std::string& path, const DepthGrid& grid, std::span<const SecondaryCamera> secondaries,
                      Checksum checksum) {
  const MapCalibration wanted = map_calibration(grid, secondaries);
  return load(path, &wanted, checksum);
}

MapFileHeader read_map_info(const std::string& path) {
  const std::shared_ptr<const MappedFile> file = MappedFile::open(path);  // reads no page but those that are looked at
  return naming(path, [&] { return decode_header(file->bytes(), file->bytes().size()); });
}

}  // namespace depthgrid::grid
