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
constexpr int kFrames = 50;  // fakenect ends the program at the end

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

/// One for all tests: fakenect goes on in it from one camera to the next.
const test::TemporaryFolder& dump() {
  static const test::TemporaryFolder folder;
  static const bool written = [] {
    write_dump(folder);
    return true;
  }();
  (void)written;
  return folder;
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
    ASSERT_EQ(setenv("FAKENECT_PATH", dump().path().c_str(), 1), 0);  // NOLINT(concurrency-mt-unsafe)
    library_ = std::make_shared<const FreenectLibrary>(std::vector<std::string>{fakenect().string()});
  }

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

// What stands between a test and the functions of fakenect, which loses nothing and logs nothing.
freenect::OnLog log_to = nullptr;
int log_level = -1;
int loses_in = -1;  ///< calls until packets are lost; negative: none are
int (*real_events)(freenect::Context*, timeval*) = nullptr;

int events_with_loss(freenect::Context* context, timeval* wait) {
  if (loses_in == 0 && log_level >= freenect::kInfo) {
    log_to(context, freenect::kInfo, "[Stream 70] Lost 2 packets\n");
  }
  --loses_in;
  return real_events(context, wait);
}

TEST_F(Freenect, AnImageWithLostPacketsIsPassedOver) {
  freenect::Functions functions = library_->functions();
  real_events = functions.process_events_timeout;
  functions.process_events_timeout = &events_with_loss;
  functions.set_log_callback = [](freenect::Context*, freenect::OnLog to) { log_to = to; };
  functions.set_log_level = [](freenect::Context*, int level) { log_level = level; };
  FreenectSettings settings;
  settings.arrival.time_uncertainty_s = 0.1;
  FreenectCamera camera(settings, std::make_shared<const FreenectLibrary>(functions));
  camera.open();
  const auto take = [&](DepthReading& reading) {
    Reading found = Reading::nothing;
    const double end_s = clock_now_s() + 20;
    while ((found = camera.next(reading, 0.05)) == Reading::nothing && clock_now_s() < end_s) {
    }
    return found;
  };
  DepthReading reading;
  ASSERT_EQ(take(reading), Reading::got) << camera.reason();
  for (int n = 0; n < 3; ++n) {
    ASSERT_EQ(take(reading), Reading::got) << camera.reason();
    EXPECT_EQ(reading.skipped, 0) << "nothing was lost yet";
  }
  loses_in = 0;
  ASSERT_EQ(take(reading), Reading::got) << camera.reason();
  EXPECT_EQ(reading.skipped, 2);
  ASSERT_EQ(take(reading), Reading::got) << camera.reason();
  EXPECT_EQ(reading.skipped, 0);
}

TEST_F(Freenect, ItsClockAloneIsNotBelieved) {
  FreenectCamera camera({}, library_);
  EXPECT_THAT(test::thrown_message([&] { camera.open(); }),
              HasSubstr("the Kinect's clock is known here by the arrival of its images alone, up to 0.1 s after"));
}

}  // namespace
}  // namespace depthgrid::sensors
