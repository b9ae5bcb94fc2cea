// Map files: there and back, and every kind of broken file with its message.
#include "depthgrid/grid/map/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <vector>

#include "depthgrid/grid/map/map_builder.hpp"
#include "grid/map_rigs.hpp"

namespace depthgrid::grid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Content = std::vector<char>;

// Offsets in the file's head.
constexpr std::size_t kByteOrderAt = 8, kVersionAt = 12, kStorageAt = 16, kNumbersAt = 20, kFingerprintAt = 24,
                      kHeaderBytesAt = 32, kTableBytesAt = 40, kCellsAt = 48, kRowsAt = 56, kCalibrationAt = 64;
constexpr std::size_t kFirstSecondaryWidth = 10, kFirstPoseEntry = 16;  // among the calibration numbers

MapCalibration small_rig() {
  MapCalibration rig;
  rig.principal = {5, 4, 5, 5, 2.5, 2};
  rig.quantisation = {0.3, 0.1, 0.0, 20};
  rig.secondaries = {{{6, 5, 5, 5, 3, 2.5}, look_at({1, 0, 1}, {0, 0, 1.2}, {0, -1, 0}).inverse()},
                     {{8, 3, 5, 5, 4, 1.5}, look_at({0.1, 0.1, 3}, {0, 0, 1.2}, {0, -1, 0}).inverse()}};
  return rig;
}

template <class T>
T get(const Content& content, std::size_t offset) {
  T value;
  std::memcpy(&value, content.data() + offset, sizeof value);
  return value;
}

template <class T>
void put(Content& content, std::size_t offset, T value) {
  std::memcpy(content.data() + offset, &value, sizeof value);
}

void put_right_checksum(Content& content) {
  const std::size_t end = content.size() - 4;
  put(content, end,
      static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size() - 8)));
}

class MapFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("depthgrid_map_file_test_" + std::to_string(::getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name = "map.dgm") const { return (folder_ / name).string(); }

  Content saved(MapStorage storage) {
    save_map(build_map(grid_of(rig_), rig_.secondaries, storage), path());
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  void write(const Content& content) {
    std::ofstream(path(), std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  }

  /// The message with which the content is refused; it is one line and names the file.
  std::string refusal(const Content& content) {
    write(content);
    try {
      load_map(path());
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("file '" + path() + "'"), Not(HasSubstr("\n"))));
      return error.what();
    }
    return "loaded";
  }

  /// As above, after the checksum has been made to fit: a crafted file.
  std::string crafted_refusal(Content content) {
    put_right_checksum(content);
    return refusal(content);
  }

  MapCalibration rig_ = small_rig();
  fs::path folder_;
};

TEST_F(MapFile, OnePixelThereAndBack) {
  const OnePixelMap built = build_one_pixel_map(grid_of(rig_), rig_.secondaries);
  save_map(built, path());
  const auto loaded = std::get<OnePixelMap>(load_map(path(), grid_of(rig_), rig_.secondaries));
  ASSERT_EQ(loaded.cells().size(), built.cells().size());
  EXPECT_EQ(std::memcmp(loaded.cells().data(), built.cells().data(), built.cells().size_bytes()), 0);
  EXPECT_EQ(difference(loaded.calibration(), rig_), "");
  EXPECT_EQ(fingerprint(loaded.calibration()), fingerprint(rig_));
}

TEST_F(MapFile, ListsThereAndBackAndOutliveTheFile) {
  const PixelListMap built = build_pixel_list_map(grid_of(rig_), rig_.secondaries);
  save_map(built, path());
  DepthGridMap first = load_map(path());
  const DepthGridMap copy = first;
  first = ClosedFormMap(grid_of(rig_), rig_.secondaries);
  fs::remove(path());
  const auto& loaded = std::get<PixelListMap>(copy);
  const std::vector<float> depth_m(40, 1.0F);
  std::int64_t involved = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    for (int ray = 0; ray < 20; ++ray) {
      for (int n = 0; n < 20; ++n) {
        const Confirmation answer = built.ray(ray % 5, ray / 5, k).confirm(n, depth_m.data());
        involved += answer != Confirmation::not_involved ? 1 : 0;
        EXPECT_EQ(loaded.ray(ray % 5, ray / 5, k).confirm(n, depth_m.data()), answer);
      }
    }
  }
  EXPECT_GT(involved, 100);
}

TEST_F(MapFile, HeadTellsWhatItIs) {
  const Content content = saved(MapStorage::pixel_lists);
  const MapFileHeader header = read_map_info(path());
  EXPECT_EQ(header.storage, MapStorage::pixel_lists);
  EXPECT_EQ(header.version, kMapFileVersion);
  EXPECT_EQ(header.file_bytes, content.size());
  EXPECT_EQ(header.calibration.secondaries.size(), 2U);
  EXPECT_EQ(header.fingerprint, fingerprint(rig_));
  EXPECT_GT(header.rows, header.cells / 2);
}

TEST_F(MapFile, SavingLeavesNothingElseBehind) {
  saved(MapStorage::one_pixel);
  saved(MapStorage::pixel_lists);  // replaces it
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  EXPECT_EQ(read_map_info(path()).storage, MapStorage::pixel_lists);
}

TEST_F(MapFile, SavingWhereItCannotIsAnErrorAndKeepsTheOldFile) {
  fs::create_directories(path("taken") + "/child");
  const DepthGridMap map = build_one_pixel_map(grid_of(rig_), rig_.secondaries);
  EXPECT_THROW(save_map(map, path("taken")), Error) << "a folder that is not empty cannot be replaced";
  EXPECT_THROW(save_map(map, path("absent/map.dgm")), Error);
  EXPECT_THROW(save_map(ClosedFormMap(grid_of(rig_), rig_.secondaries), path()), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(MapFile, LoadingWithAnotherCalibrationNamesTheNumber) {
  saved(MapStorage::one_pixel);
  std::vector<SecondaryCamera> other = rig_.secondaries;
  other[1].camera.fx_px = 6;
  try {
    load_map(path(), grid_of(rig_), other);
    ADD_FAILURE() << "loaded";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr(path()), HasSubstr("secondary camera 1: fx [px] is 5 in the map, wanted is 6")));
  }
  DepthQuantisation finer = rig_.quantisation;
  finer.step_m = 0.05;
  EXPECT_THROW(load_map(path(), DepthGrid(rig_.principal, finer), rig_.secondaries), Error);
}

TEST_F(MapFile, AbsentEmptyOrFolder) {
  EXPECT_THROW(load_map(path("absent")), Error);
  EXPECT_THROW(load_map(folder_.string()), Error);
  EXPECT_THAT(refusal({}), HasSubstr("is empty"));
}

TEST_F(MapFile, CutOffAnywhere) {
  for (const MapStorage storage : {MapStorage::one_pixel, MapStorage::pixel_lists}) {
    const Content content = saved(storage);
    for (std::size_t size = 1; size < content.size(); size += 1 + size / 7) {
      EXPECT_THAT(refusal({content.begin(), content.begin() + static_cast<std::ptrdiff_t>(size)}),
                  HasSubstr("is it cut off?"))
          << size;
    }
    EXPECT_THAT(refusal({content.begin(), content.end() - 1}), HasSubstr("is it cut off?"));
  }
}

TEST_F(MapFile, EveryFlippedByteIsNoticed) {
  for (const MapStorage storage : {MapStorage::one_pixel, MapStorage::pixel_lists}) {
    const Content content = saved(storage);
    for (std::size_t i = 0; i < content.size(); i += content.size() < 4000 ? 1 : 97) {
      Content damaged = content;
      damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
      EXPECT_NE(refusal(damaged), "loaded") << "byte " << i;
    }
  }
}

TEST_F(MapFile, DamagedTableFailsTheChecksum) {
  Content content = saved(MapStorage::one_pixel);
  content[content.size() - 20] = static_cast<char>(content[content.size() - 20] ^ 1);
  EXPECT_THAT(refusal(content), HasSubstr("checksum is"));
}

TEST_F(MapFile, AddedBytes) {
  Content content = saved(MapStorage::one_pixel);
  content.push_back(0);
  EXPECT_THAT(refusal(content), HasSubstr("something was added"));
}

struct BrokenHead {
  const char* what;
  std::function<void(Content&)> change;
  const char* message;
};

TEST_F(MapFile, BrokenHeads) {
  const std::vector<BrokenHead> cases = {
      {"not a map", [](Content& c) { c[0] = 'X'; }, "not a depth grid map"},
      {"other byte order", [](Content& c) { put(c, kByteOrderAt, 0x04030201U); }, "the other byte order"},
      {"no byte order", [](Content& c) { put(c, kByteOrderAt, 7U); }, "byte-order mark is 7"},
      {"later version", [](Content& c) { put(c, kVersionAt, 2U); }, "has version 2, this program reads version 1"},
      {"unknown storage", [](Content& c) { put(c, kStorageAt, 3U); }, "storage is 3, must be 1"},
      {"too many numbers", [](Content& c) { put(c, kNumbersAt, 0xFFFFFFFFU); },
       "calibration numbers, must be between 1 and"},
      {"no numbers", [](Content& c) { put(c, kNumbersAt, 0U); }, "has 0 calibration numbers"},
      {"count of numbers", [](Content& c) { put(c, kNumbersAt, 45U); }, "calibration has 45 numbers"},
      {"length of head", [](Content& c) { put<std::uint64_t>(c, kHeaderBytesAt, 64); }, "head has 64 bytes, must have"},
      {"fingerprint", [](Content& c) { put<std::uint64_t>(c, kFingerprintAt, 1); }, "fingerprint is 1"},
      {"size of tables", [](Content& c) { put<std::uint64_t>(c, kTableBytesAt, ~0ULL); }, "bytes of tables"},
      {"cells overflow", [](Content& c) { put<std::uint64_t>(c, kCellsAt, 1ULL << 61U); }, "head names"},
      {"rows overflow", [](Content& c) { put<std::uint64_t>(c, kRowsAt, 1ULL << 62U); }, "head names"},
      {"width is no number", [](Content& c) { put(c, kCalibrationAt, std::nan("")); }, "a width is nan"},
      {"height is half", [](Content& c) { put(c, kCalibrationAt + 8, 4.5); }, "a height is 4.5"},
      {"width is huge", [](Content& c) { put(c, kCalibrationAt, 2e9); }, "width is 2000000000 px"},
      {"focal length", [](Content& c) { put(c, kCalibrationAt + 16, -5.0); }, "principal camera: fx is -5 px"},
      {"step", [](Content& c) { put(c, kCalibrationAt + 56, 0.0); }, "step is 0 m"},
      {"count of cells", [](Content& c) { put(c, kCalibrationAt + 72, 1e5); }, "count is 100000 cells"},
      {"secondary width", [](Content& c) { put(c, kCalibrationAt + 8 * kFirstSecondaryWidth, 0.0); },
       "secondary camera 0: width is 0 px"},
      {"pose is not rigid", [](Content& c) { put(c, kCalibrationAt + 8 * kFirstPoseEntry, 3.0); },
       "secondary camera 0: pose: rotation deviates"},
      {"end mark", [](Content& c) { c[c.size() - 8] = 'X'; }, "does not end with DGRM"},
  };
  for (const MapStorage storage : {MapStorage::one_pixel, MapStorage::pixel_lists}) {
    const Content content = saved(storage);
    for (const BrokenHead& broken : cases) {
      Content changed = content;
      broken.change(changed);
      EXPECT_THAT(crafted_refusal(changed), HasSubstr(broken.message)) << broken.what;
    }
  }
}

TEST_F(MapFile, CraftedOnePixelTables) {
  const Content content = saved(MapStorage::one_pixel);
  const auto first = static_cast<std::size_t>(get<std::uint64_t>(content, kHeaderBytesAt));
  Content wide = content;
  put<std::uint16_t>(wide, first, 6);
  put<std::uint16_t>(wide, first + 2, 0);
  EXPECT_THAT(crafted_refusal(wide), HasSubstr("cell 0 names pixel (6, 0)"));
  Content high = content;
  put<std::uint16_t>(high, first, 0);
  put<std::uint16_t>(high, first + 2, 0xFFFF);
  EXPECT_THAT(crafted_refusal(high), HasSubstr("must lie in the 6 x 5 image of secondary camera 0"));
  Content no_depth = content;
  put<std::uint32_t>(no_depth, first, 0);
  put(no_depth, first + 4, std::nanf(""));
  EXPECT_THAT(crafted_refusal(no_depth), HasSubstr("with d_start nan m"));
}

TEST_F(MapFile, CraftedLists) {
  const Content content = saved(MapStorage::pixel_lists);
  const auto rays = static_cast<std::size_t>(get<std::uint64_t>(content, kHeaderBytesAt));
  const std::size_t cells = rays + 2 * 20 * sizeof(PixelListMap::RayHeader);
  const std::size_t rows =
      cells + static_cast<std::size_t>(get<std::uint64_t>(content, kCellsAt)) * sizeof(PixelListMap::Cell);
  std::size_t ray = rays;
  while (get<PixelListMap::RayHeader>(content, ray).n_count == 0) {
    ray += sizeof(PixelListMap::RayHeader);
  }

  const auto with = [&](std::size_t offset, auto value) {
    Content changed = content;
    put(changed, offset, value);
    return crafted_refusal(changed);
  };
  EXPECT_THAT(with(ray, std::uint64_t{1} << 60U), HasSubstr("must follow the ray before it"));
  EXPECT_THAT(with(ray + 8, ~std::uint64_t{0}), HasSubstr("must follow the ray before it"));
  EXPECT_THAT(with(ray + 16, std::uint16_t{0xFFFF}), HasSubstr("must lie within both"));
  EXPECT_THAT(with(ray + 18, std::uint16_t{0xFFFF}), HasSubstr("must lie within both"));
  EXPECT_THAT(with(ray + 20, 1U), HasSubstr("must follow the ray before it"));
  EXPECT_THAT(with(cells, -1.0F), HasSubstr("with d_start -1 m"));
  EXPECT_THAT(with(cells + 4, 0xFFFFFFFFU), HasSubstr("must begin at 0"));
  EXPECT_THAT(with(cells + 8, std::uint16_t{0xFFFF}), HasSubstr("must lie in the 5 rows of secondary camera 0"));
  EXPECT_THAT(with(cells + 10, std::uint16_t{0xFFFF}), HasSubstr("end within the table"));
  EXPECT_THAT(with(rows, std::uint16_t{0xFFFF}), HasSubstr("must be in order and below the width 6"));
  EXPECT_THAT(with(rows + 2, std::uint16_t{6}), HasSubstr("must be in order and below the width 6"));
}

TEST_F(MapFile, ChecksumCanBeLeftOutButTablesAreChecked) {
  Content content = saved(MapStorage::one_pixel);
  content.back() = static_cast<char>(content.back() ^ 1);
  write(content);
  EXPECT_THROW(load_map(path()), Error);
  EXPECT_NO_THROW(load_map(path(), Checksum::ignore));
  put<std::uint32_t>(content, static_cast<std::size_t>(get<std::uint64_t>(content, kHeaderBytesAt)), 0x00FF00FFU);
  write(content);
  EXPECT_THROW(load_map(path(), Checksum::ignore), Error);
}

TEST_F(MapFile, BytesAtAnOddAddressAreRefused) {
  const Content content = saved(MapStorage::one_pixel);
  std::vector<std::uint64_t> memory(content.size() / 8 + 2);
  auto* bytes = reinterpret_cast<std::byte*>(memory.data());
  std::memcpy(bytes, content.data(), content.size());
  EXPECT_NO_THROW(map_from_bytes({bytes, content.size()}, nullptr));
  std::memcpy(bytes + 4, content.data(), content.size());
  EXPECT_THROW(map_from_bytes({bytes + 4, content.size()}, nullptr), Error);
}

}  // namespace
}  // namespace depthgrid::grid
