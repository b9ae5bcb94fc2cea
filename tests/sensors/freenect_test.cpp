// A Kinect v1, by fakenect: Debian's stand-in for libfreenect, which plays a dump.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/freenect_camera.hpp"
#include "depthgrid/sensors/freenect_library.hpp"
#include "files/temporary_folder.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::sensors {
namespace {

using ::testing::HasSubstr;

constexpr int kPixels = 640 * 480;
constexpr int kFrames = 30;

std::uint16_t raw_pixel(int frame, int index) { return static_cast<std::uint16_t>((index + 11 * frame) % 2048); }

/// A dump as fakenect-record makes it: a PGM an image, named after its times.
void write_dump(const test::TemporaryFolder& folder) {
  std::ofstream index(folder / "INDEX.txt");
  std::vector<std::uint16_t> raw(kPixels);
  for (int frame = 0; frame < kFrames; ++frame) {
    for (int k = 0; k < kPixels; ++k) {
      raw[static_cast<std::size_t>(k)] = raw_pixel(frame, k);
    }
    const std::string name =
        "d-" + std::to_string(1000 + frame / 30.0) + "-" + std::to_string(5 + 2000000 * frame) + ".pgm";
    index << name << '\n';
    std::ofstream image(folder / name, std::ios::binary);
    image << "P5 640 480 65535\n";
    image.write(reinterpret_cast<const char*>(raw.data()), 2 * kPixels);  // NOLINT(*reinterpret-cast)
  }
}

std::filesystem::path fakenect() {
  for (const char* folder :
       {"/usr/lib/x86_64-linux-gnu/fakenect", "/usr/lib/aarch64-linux-gnu/fakenect", "/usr/lib/fakenect"}) {
    const auto file = std::filesystem::path(folder) / "libfreenect.so.0.5";
    if (std::filesystem::exists(file)) {
      return file;
    }
  }
  return {};
}

TEST(KinectDisparity, FollowsThePublishedFormulaAndRoundsDown) {
  const KinectDisparity disparity;
  EXPECT_EQ(disparity.mm(2047), 0) << "no reading";
  EXPECT_EQ(disparity.mm(4000), 0);
  // raw 801.5 is the reference plane, 1.2 m away: one step of a quarter pixel farther or nearer.
  EXPECT_EQ(disparity.mm(800), 1193);
  EXPECT_EQ(disparity.mm(803), 1206);
  double last_mm = 0;
  int readings = 0;
  for (std::uint16_t raw = 0; raw < 2047; ++raw) {
    const double mm = disparity.mm(raw);
    if (mm > 0) {
      EXPECT_GE(mm, last_mm) << "a greater disparity is farther away";
      last_mm = mm;
      ++readings;
      const double metric = (raw / 4.0 - 200 - 0.375) * 0.1042;
      const double exact_mm = 10 * 120 * 7.5 / (7.5 - metric);
      EXPECT_LE(mm, exact_mm + 1e-6);
      EXPECT_GT(mm, exact_mm - 1 - 1e-6);
    }
  }
  EXPECT_LE(last_mm, 10000);
  EXPECT_GT(last_mm, 9000);
  EXPECT_GT(readings, 1000);
}

TEST(FreenectLibrary, OneThatIsNotThereIsOneLine) {
  EXPECT_THAT(test::thrown_message([] { const FreenectLibrary library({"libfreenect_not_there.so"}); }),
              HasSubstr("tried libfreenect_not_there.so: install libfreenect (Debian: libfreenect0.5)"));
}

class Freenect : public testing::Test {
 protected:
  void SetUp() override {
    if (fakenect().empty()) {
      GTEST_SKIP() << "there is no fakenect: Debian's package libfreenect-bin";
    }
    write_dump(folder_);
    ASSERT_EQ(setenv("FAKENECT_PATH", folder_.path().c_str(), 1), 0);  // NOLINT(concurrency-mt-unsafe)
    library_ = std::make_shared<const FreenectLibrary>(std::vector<std::string>{fakenect().string()});
  }

  test::TemporaryFolder folder_;
  std::shared_ptr<const FreenectLibrary> library_;
};

TEST_F(Freenect, EveryImageIsConvertedToTheBitWithTheDevicesTimes) {
  FreenectSettings settings;
  settings.arrival = {.lag_s = 0.03, .time_uncertainty_s = 0.07};
  FreenectCamera camera(settings, library_);
  DepthReading reading;
  EXPECT_EQ(camera.next(reading, 0), Reading::failed) << "not open";
  EXPECT_EQ(camera.reason(), "is not open");
  camera.open();
  EXPECT_EQ(camera.info().name, "Kinect v1");
  EXPECT_FALSE(camera.info().intrinsics) << "the device states none";
  EXPECT_THAT(camera.info().settings, HasSubstr("not the device's"));
  const KinectDisparity disparity;
  int frame = static_cast<int>(DeviceClock::kImages) - 1;
  std::optional<double> before_s;
  for (int n = 0; n < 12; ++n) {
    Reading found = Reading::nothing;
    const double end_s = clock_now_s() + 20;
    while ((found = camera.next(reading, 0.05)) == Reading::nothing && clock_now_s() < end_s) {
    }
    ASSERT_EQ(found, Reading::got) << camera.reason();
    frame += static_cast<int>(reading.skipped - (n == 0 ? DeviceClock::kImages - 1 : 0));
    for (int k = 0; k < kPixels; ++k) {
      std::uint16_t mm = 0;
      std::memcpy(&mm, static_cast<const char*>(reading.depth.data) + 2 * k, sizeof mm);
      ASSERT_EQ(mm, disparity.mm(raw_pixel(frame, k))) << "pixel " << k << " of image " << frame;
    }
    EXPECT_LT(reading.time_s, clock_now_s() - 0.029) << "the lag is taken off";
    if (before_s) {
      EXPECT_GT(reading.time_s, *before_s);
      EXPECT_LT(reading.time_s - *before_s, 1);
    }
    before_s = reading.time_s;
    ++frame;
  }
  camera.close();
  EXPECT_EQ(camera.next(reading, 0), Reading::failed);
  camera.open();
}

TEST_F(Freenect, ItsClockAloneIsNotBelieved) {
  FreenectCamera camera({}, library_);
  EXPECT_THAT(test::thrown_message([&] { camera.open(); }),
              HasSubstr("the Kinect's clock is known here by the arrival of its images alone, up to 0.1 s after"));
}

}  // namespace
}  // namespace depthgrid::sensors
