// libFuzzer target: any bytes as a depth grid map's file. Either they are refused with an Error of one line that
// prints, or every look-up in the map stays within its tables and the images.
//
// The first byte of an input says which of the checks that random bytes never pass are made to fit first, so that the
// fuzzer gets past them: 1 fingerprint, 2 sizes in the head and of the file, 4 end mark. The checksum is not compared.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/grid/map/map_file.hpp"

namespace {

using depthgrid::Error;
namespace grid = depthgrid::grid;

constexpr unsigned kFitFingerprint = 1, kFitSizes = 2, kFitEnd = 4;
constexpr std::size_t kStorageAt = 16, kNumbersAt = 20, kFingerprintAt = 24, kHeaderBytesAt = 32, kTableBytesAt = 40,
                      kCellsAt = 48, kRowsAt = 56, kCalibrationAt = 64;
constexpr std::size_t kLargestFile = std::size_t{1} << 20U;
constexpr std::size_t kLargestImage = std::size_t{1} << 20U;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

/// A file's bytes at an address that maps may begin at.
class File {
 public:
  File(const std::uint8_t* data, std::size_t size) : memory_(size / 8 + 1), size_(size) {
    std::memcpy(memory_.data(), data, size);
  }
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return {reinterpret_cast<const std::byte*>(memory_.data()), size_};
  }
  template <class T>
  [[nodiscard]] T get(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes().data() + offset, sizeof value);
    return value;
  }
  template <class T>
  void put(std::size_t offset, T value) {
    std::memcpy(reinterpret_cast<std::byte*>(memory_.data()) + offset, &value, sizeof value);
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  void resize(std::size_t size) {
    memory_.resize(size / 8 + 1);
    size_ = size;
  }

 private:
  std::vector<std::uint64_t> memory_;
  std::size_t size_;
};

void fit(File& file, unsigned what) {
  if (file.size() < kCalibrationAt) {
    return;
  }
  const auto count = file.get<std::uint32_t>(kNumbersAt);
  if (count == 0 || count > (file.size() - kCalibrationAt) / sizeof(double)) {
    return;
  }
  std::vector<double> values(count);
  std::memcpy(values.data(), file.bytes().data() + kCalibrationAt, count * sizeof(double));
  grid::MapFileHeader header;
  try {
    header.storage =
        file.get<std::uint32_t>(kStorageAt) == 1 ? grid::MapStorage::one_pixel : grid::MapStorage::pixel_lists;
    header.calibration = grid::calibration_from_numbers(values, "fuzz");
    header.cells = file.get<std::uint64_t>(kCellsAt);
    header.rows = file.get<std::uint64_t>(kRowsAt);
    if ((what & kFitSizes) != 0 && header.storage == grid::MapStorage::one_pixel) {
      header.cells = grid::cell_count(header.calibration) * header.calibration.secondaries.size();
      header.rows = 0;
    }
    complete(header);
  } catch (const Error&) {
    return;
  }
  if ((what & kFitFingerprint) != 0) {
    file.put(kFingerprintAt, header.fingerprint);
  }
  if ((what & kFitSizes) != 0 && header.file_bytes <= kLargestFile) {
    file.put(kHeaderBytesAt, header.header_bytes);
    file.put(kTableBytesAt, header.table_bytes);
    file.put(kCellsAt, header.cells);
    file.put(kRowsAt, header.rows);
    file.resize(header.file_bytes);
  }
  if ((what & kFitEnd) != 0 && file.size() >= 8) {
    file.put(file.size() - 8, std::array<char, 4>{'D', 'G', 'R', 'M'});
  }
}

/// Looks every cell up, with depth images of exactly the calibration's size.
template <class Map>
void look_up(const Map& map) {
  const grid::MapCalibration& calibration = map.calibration();
  require(map.camera_count() == calibration.secondaries.size());
  for (std::size_t k = 0; k < map.camera_count(); ++k) {
    const depthgrid::PinholeCamera& camera = calibration.secondaries[k].camera;
    const std::size_t pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
    if (pixels > kLargestImage) {
      continue;
    }
    // Farther than any d_start: the lists are read to their end.
    const std::vector<float> depth_m(pixels, std::numeric_limits<float>::infinity());
    for (int v = 0; v < calibration.principal.height_px; ++v) {
      for (int u = 0; u < calibration.principal.width_px; ++u) {
        const auto ray = map.ray(u, v, k);
        for (int n = 0; n < calibration.quantisation.count; ++n) {
          require(ray.confirm(n, depth_m.data()) != grid::Confirmation::confirmed);
        }
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  File file(data + 1, size - 1);
  fit(file, data[0]);
  try {
    const grid::DepthGridMap map = grid::map_from_bytes(file.bytes(), nullptr, grid::Checksum::ignore);
    if (const auto* one_pixel = std::get_if<grid::OnePixelMap>(&map)) {
      look_up(*one_pixel);
    } else {
      look_up(std::get<grid::PixelListMap>(map));
    }
  } catch (const Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  return 0;
}
