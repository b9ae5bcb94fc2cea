// RealSense cameras by the real librealsense2, which scripts/realsense-library builds: its software device in place of
// a connected one, what it records of that, and a recording of a real D435. Ends with 77, skipped, where it is not
// built.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/realsense_camera.hpp"
#include "depthgrid/sensors/realsense_library.hpp"
#include "depthgrid/sensors/realsense_recording.hpp"
#include "files/temporary_folder.hpp"
#include "sensors/wait_for_reading.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::sensors {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr const char* kLibrary = "build/librealsense/lib/librealsense2.so";

// NOLINTBEGIN(*avoid-c-arrays): the library's own structures, of its software device.
struct VideoStream {
  int type = rs2::kDepth;
  int index = 0;
  int uid = 7;
  int width = kWidth;
  int height = kHeight;
  int fps = 30;
  int bpp = 2;
  int format = rs2::kZ16;
  rs2::Intrinsics intrinsics{kWidth, kHeight, 319.25F, 241.5F, 385.5F, 386.25F, 4, {0, 0, 0, 0, 0}};
};
struct VideoFrame {
  void* pixels = nullptr;
  void (*deleter)(void*) = nullptr;
  int stride = 2 * kWidth;
  int bpp = 2;
  double timestamp_ms = 0;
  int domain = rs2::kSystemTime;
  int number = 0;
  const rs2::Profile* profile = nullptr;
};
// NOLINTEND(*avoid-c-arrays)

std::uint16_t sent_pixel(int number, int k) { return static_cast<std::uint16_t>(300 + (k + 17 * number) % 4000); }

/// -1: another image.
int number_of(const DepthView& depth) {
  std::vector<std::uint16_t> pixels(static_cast<std::size_t>(kWidth) * kHeight);
  std::memcpy(pixels.data(), depth.data, 2 * pixels.size());
  for (int number = 0; number < 240; ++number) {
    if (pixels[0] != sent_pixel(number, 0)) {
      continue;
    }
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      if (pixels[k] != sent_pixel(number, static_cast<int>(k))) {
        return -1;
      }
    }
    return number;
  }
  return -1;
}

/// The library, and a software device that takes the place of the connected ones.
class Software {
 public:
  Software() : shared_(std::vector<std::string>{kLibrary}, "scripts/realsense-library builds it"), real_({kLibrary}) {
    shared_.get("rs2_create_software_device", create_);
    shared_.get("rs2_software_device_add_sensor", add_sensor_);
    shared_.get("rs2_software_sensor_add_video_stream", add_stream_);
    shared_.get("rs2_software_sensor_add_read_only_option", add_option_);
    shared_.get("rs2_software_sensor_on_video_frame", on_frame_);
  }
  [[nodiscard]] const rs2::Library& real() const { return real_; }
  [[nodiscard]] const SharedLibrary& shared() const { return shared_; }

  /// Begins one; there is one at a time.
  rs2::Device* device() {
    device_ = real_.call(create_);
    sensor_ = real_.call(add_sensor_, device_, "Stereo Module");
    profile_ = real_.call(add_stream_, sensor_, VideoStream{});
    constexpr int kDepthUnits = 28;
    real_.call(add_option_, sensor_, kDepthUnits, 0.001F);
    return device_;
  }
  void send(int number, double stamp_s, int domain) {
    auto* const pixels = new std::uint16_t[static_cast<std::size_t>(kWidth) * kHeight];  // NOLINT(*owning-memory)
    for (int k = 0; k < kWidth * kHeight; ++k) {
      pixels[k] = sent_pixel(number, k);
    }
    VideoFrame frame;
    frame.pixels = pixels;
    frame.deleter = [](void* data) { delete[] static_cast<std::uint16_t*>(data); };  // NOLINT(*owning-memory)
    frame.timestamp_ms = 1e3 * stamp_s;
    frame.domain = domain;
    frame.number = number;
    frame.profile = profile_;
    real_.call(on_frame_, sensor_, frame);
  }

 private:
  SharedLibrary shared_;
  rs2::Library real_;
  rs2::Device* (*create_)(rs2::ErrorObject**) = nullptr;
  rs2::Sensor* (*add_sensor_)(rs2::Device*, const char*, rs2::ErrorObject**) = nullptr;
  rs2::Profile* (*add_stream_)(rs2::Sensor*, VideoStream, rs2::ErrorObject**) = nullptr;
  void (*add_option_)(rs2::Sensor*, int, float, rs2::ErrorObject**) = nullptr;
  void (*on_frame_)(rs2::Sensor*, VideoFrame, rs2::ErrorObject**) = nullptr;
  rs2::Device* device_ = nullptr;
  rs2::Sensor* sensor_ = nullptr;
  rs2::Profile* profile_ = nullptr;
};

Software& software() {
  static Software one;
  return one;
}

/// The library's functions, but that the only connected device is the software one.
std::shared_ptr<const rs2::Library> with_software_device() {
  rs2::Functions functions = software().real().functions();
  functions.get_device_count = [](const rs2::DeviceList*, rs2::ErrorObject**) { return 1; };
  functions.create_device = [](const rs2::DeviceList*, int, rs2::ErrorObject**) { return software().device(); };
  functions.is_sensor_extendable_to = [](const rs2::Sensor*, int, rs2::ErrorObject**) { return 1; };
  functions.get_depth_scale = [](rs2::Sensor*, rs2::ErrorObject**) { return 0.001F; };
  return std::make_shared<const rs2::Library>(functions, "librealsense2 with a software device");
}

TEST(RealRealSense, WithoutADeviceItSaysSo) {
  const auto library = std::make_shared<const rs2::Library>(std::vector<std::string>{kLibrary});
  RealSenseCamera camera({.serial = "000000000000"}, library);
  EXPECT_THAT(test::thrown_message([&] { camera.open(); }), HasSubstr("RealSense"));
}

TEST(RealRealSense, ImagesOfASoftwareDeviceComeToTheBit) {
  RealSenseSettings settings;
  settings.arrival = {.lag_s = 0.03, .time_uncertainty_s = 0.07};
  RealSenseCamera camera(settings, with_software_device());
  camera.open();
  ASSERT_TRUE(camera.info().intrinsics);
  EXPECT_NEAR(camera.info().intrinsics->fx_px, 385.5, 1e-9);
  EXPECT_NEAR(camera.info().intrinsics->cx_px, 319.75, 1e-9);
  for (int number = 0; number < 30; ++number) {
    const double sent_s = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    software().send(number, sent_s, rs2::kSystemTime);
    DepthReading reading;
    ASSERT_EQ(wait_for_reading(camera, reading), Reading::got) << camera.reason();
    EXPECT_EQ(number_of(reading.depth), number);
    EXPECT_EQ(reading.skipped, 0);
    EXPECT_LT(reading.time_s, clock_now_s() - 0.029);
    EXPECT_GT(reading.time_s, clock_now_s() - 2);
  }
}

TEST(RealRealSense, ARecordingOfARealCameraIsReadToTheBit) {
  const char* const data = std::getenv("DEPTHGRID_DATA");  // NOLINT(concurrency-mt-unsafe)
  const fs::path folder = fs::path(data != nullptr ? data : "../shared/data") / "raw_recordings";
  const fs::path file = folder / "d435_single_depth_color_640x480.bag";
  if (!fs::exists(file)) {
    GTEST_SKIP() << "there is no " << file.string() << ": set DEPTHGRID_DATA to the folder that holds 'raw_recordings'";
  }
  const auto library = std::make_shared<const rs2::Library>(std::vector<std::string>{kLibrary});
  const ArrivalTimes declared{.lag_s = {}, .time_uncertainty_s = 0.1};
  const RealSenseSpan span = realsense_span(file, declared, library);
  ASSERT_TRUE(span.info.intrinsics);
  EXPECT_NEAR(span.info.intrinsics->fx_px, 390.43145751953125, 1e-6);
  EXPECT_NEAR(span.info.intrinsics->cx_px, 331.38787841796875 + 0.5, 1e-6);
  EXPECT_EQ(span.info.metres_per_unit, 0.001);
  const auto playback = std::make_shared<const Playback>(span.first_s, span.last_s, false, Pace::as_fast_as_asked);
  RealSenseRecording source(file, playback, declared, library);
  source.open();
  DepthReading reading;
  double first_s = 0;
  int images = 0;
  while (wait_for_reading(source, reading) == Reading::got) {
    ASSERT_LT(images, 2);
    const files::Gray16Image image =
        files::read_png16(folder / "decoded" / (images == 0 ? "d435_0.png" : "d435_1.png"));
    EXPECT_EQ(std::memcmp(image.pixels.data(), reading.depth.data, 2 * image.pixels.size()), 0) << "image " << images;
    first_s = images == 0 ? reading.time_s : first_s;
    ++images;
  }
  EXPECT_EQ(images, 2) << source.reason();
  EXPECT_NEAR(reading.time_s - first_s, 0.1667, 0.02) << "as far apart as they were taken";
}

}  // namespace
}  // namespace depthgrid::sensors

int main(int argc, char** argv) {
  if (!std::filesystem::exists(depthgrid::sensors::kLibrary)) {
    std::puts("skipped: there is no librealsense2 in build/librealsense, scripts/realsense-library builds it");
    return 77;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
