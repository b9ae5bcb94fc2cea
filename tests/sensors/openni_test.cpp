// Cameras by OpenNI2 and what it recorded: Debian's library, with a driver of the tests' own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/openni_camera.hpp"
#include "depthgrid/sensors/openni_library.hpp"
#include "depthgrid/sensors/openni_stream.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/shared_library.hpp"
#include "files/temporary_folder.hpp"
#include "sensors/wait_for_reading.hpp"
#include "support/thrown_message.hpp"

// OpenNI2 keeps memory each time that it begins, and unloads the drivers that could be named as an exception.
extern "C" const char* __lsan_default_options() { return "detect_leaks=0"; }  // NOLINT: a name of the leak checker's

namespace depthgrid::sensors {
namespace {

using test::thrown_message;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

/// OpenNI2 looks for drivers beside itself: a folder with links to it, to its driver of files, and to ours.
class PrivateOpenni {
 public:
  PrivateOpenni() {
    const fs::path driver = OPENNI_TEST_DRIVER;
    for (const char* folder : {"/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib"}) {
      const fs::path files = fs::path(folder) / "OpenNI2" / "Drivers" / "libOniFile.so.0";
      const fs::path library = fs::path(folder) / "libOpenNI2.so.0";
      if (!driver.empty() && fs::exists(files) && fs::exists(library)) {
        const fs::path drivers = folder_ / "OpenNI2/Drivers";
        fs::create_directories(drivers);
        fs::create_symlink(library, folder_ / "libOpenNI2.so.0");
        fs::create_symlink(files, drivers / "libOniFile.so.0");
        fs::create_symlink(driver, drivers / "libTestDepth.so.0");
        library_ = folder_ / "libOpenNI2.so.0";
        return;
      }
    }
  }
  /// Empty: there is none.
  [[nodiscard]] const fs::path& library() const { return library_; }

 private:
  test::TemporaryFolder folder_;
  fs::path library_;
};

const PrivateOpenni& private_openni() {
  static const PrivateOpenni openni;
  return openni;
}

std::uint16_t sent_pixel(int number, int x, int y) {
  return static_cast<std::uint16_t>(500 + (7 * number + x + 3 * y) % 2000);
}

std::uint16_t pixel(const DepthView& depth, int x, int y) {
  std::uint16_t value = 0;
  std::memcpy(&value, static_cast<const char*>(depth.data) + y * depth.stride_bytes + 2 * x, sizeof value);
  return value;
}

/// The number of the driver's image that this is, to the bit; -1: another image.
int number_of(const DepthView& depth) {
  for (int number = 1; number < 2000; ++number) {
    if (sent_pixel(number, 0, 0) == pixel(depth, 0, 0)) {
      for (int y = 0; y < depth.height_px; ++y) {
        for (int x = 0; x < depth.width_px; ++x) {
          if (pixel(depth, x, y) != sent_pixel(number, x, y)) {
            return -1;
          }
        }
      }
      return number;
    }
  }
  return -1;
}

TEST(OpenniLibrary, OneThatIsNotThereIsOneLine) {
  EXPECT_THAT(thrown_message([] { const OpenniLibrary library({"libOpenNI2_not_there.so.0"}); }),
              HasSubstr("tried libOpenNI2_not_there.so.0: install OpenNI2 (Debian: libopenni2-0)"));
}

class Openni : public testing::Test {
 protected:
  void SetUp() override {
    if (private_openni().library().empty()) {
      GTEST_SKIP() << "there is no OpenNI2 with its headers: Debian's package libopenni2-dev";
    }
    const SharedLibrary driver(std::vector<std::string>{OPENNI_TEST_DRIVER}, "it is built with the tests");
    driver.get("test_openni_there", there_);
    driver.get("test_openni_unplug", unplug_);
    driver.get("test_openni_silent", silent_);
    driver.get("test_openni_registered", registered_);
    driver.get("test_openni_mirrored", mirrored_);
    driver.get("test_openni_hole_filter", hole_filter_);
    driver.get("test_openni_settings", settings_);
    there_(1, 0);
    silent_(0);
    registered_(0);
    mirrored_(1);
    hole_filter_(1);
    library_ = std::make_shared<const OpenniLibrary>(std::vector<std::string>{private_openni().library().string()});
  }
  [[nodiscard]] std::unique_ptr<OpenniCamera> camera(const std::string& device = "") const {
    OpenniSettings settings;
    settings.device = device;
    settings.arrival = {.lag_s = 0.03, .time_uncertainty_s = 0.07};
    return std::make_unique<OpenniCamera>(settings, library_);
  }
  /// Images of the driver in a file, by OpenNI2's own recorder.
  void record(const fs::path& file, int images) const;

  std::shared_ptr<const OpenniLibrary> library_;
  void (*there_)(int, int) = nullptr;
  void (*unplug_)(int) = nullptr;
  void (*silent_)(int) = nullptr;
  void (*registered_)(int) = nullptr;
  void (*mirrored_)(int) = nullptr;
  void (*hole_filter_)(int) = nullptr;
  int (*settings_)() = nullptr;
};

void Openni::record(const fs::path& file, int images) const {
  const SharedLibrary library(std::vector<std::string>{private_openni().library().string()}, "");
  int (*create)(const char*, void**) = nullptr;
  int (*attach)(void*, oni::Stream, int) = nullptr;
  int (*start)(void*) = nullptr;
  void (*stop)(void*) = nullptr;
  int (*destroy)(void**) = nullptr;
  library.get("oniCreateRecorder", create);
  library.get("oniRecorderAttachStream", attach);
  library.get("oniRecorderStart", start);
  library.get("oniRecorderStop", stop);
  library.get("oniRecorderDestroy", destroy);
  library_->begin();
  const oni::Functions& f = library_->functions();
  oni::Device device = nullptr;
  oni::Stream stream = nullptr;
  ASSERT_EQ(f.device_open("test-1", &device), oni::kOk);
  ASSERT_EQ(f.create_stream(device, oni::kDepth, &stream), oni::kOk);
  void* recorder = nullptr;
  ASSERT_EQ(create(file.c_str(), &recorder), oni::kOk);
  ASSERT_EQ(attach(recorder, stream, 0), oni::kOk);
  ASSERT_EQ(start(recorder), oni::kOk);
  ASSERT_EQ(f.stream_start(stream), oni::kOk);
  for (int n = 0; n < images; ++n) {
    int which = 0;
    oni::Frame* frame = nullptr;
    ASSERT_EQ(f.wait_for_any(&stream, 1, &which, 5000), oni::kOk);
    ASSERT_EQ(f.read_frame(stream, &frame), oni::kOk);
    f.frame_release(frame);
  }
  stop(recorder);
  f.stream_stop(stream);
  (void)destroy(&recorder);
  f.stream_destroy(stream);
  (void)f.device_close(device);
}

TEST_F(Openni, TheOnlyOneIsReadToTheBit) {
  const auto source = camera();
  DepthReading reading;
  EXPECT_EQ(source->next(reading, 0), Reading::failed) << "not open";
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  source->open();
  EXPECT_EQ(source->info().name, "Tests Depth");
  EXPECT_EQ(source->info().serial, "SN1");
  EXPECT_EQ(source->info().settings, "registration off, hole filter off, mirrored images are turned back here");
  int last = 0;
  for (int n = 0; n < 5; ++n) {
    ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
    const int number = number_of(reading.depth);
    EXPECT_GT(number, last) << "each newer, none changed";
    if (n > 0) {
      EXPECT_EQ(reading.skipped, number - last - 1);
    }
    last = number;
    EXPECT_LT(reading.time_s, clock_now_s() - 0.029) << "the lag is taken off";
  }
  source->close();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << "the library prints nothing";
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Openni, MirroringIsSwitchedOffWhereTheDeviceTakesIt) {
  mirrored_(0);
  const auto source = camera();
  source->open();
  EXPECT_EQ(source->info().settings, "registration off, hole filter off, not mirrored");
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
  EXPECT_GT(number_of(reading.depth), 0);
}

TEST_F(Openni, WhichOneItIsHasToBeKnown) {
  there_(0, 0);
  EXPECT_EQ(thrown_message([&] { camera()->open(); }), "no device of OpenNI2 is connected");
  there_(1, 1);
  EXPECT_EQ(thrown_message([&] { camera()->open(); }),
            "2 devices of OpenNI2 are connected, serial: says which one: SN1 (Tests Depth), SN2 (Tests Depth)");
  EXPECT_THAT(thrown_message([&] { camera("SN3")->open(); }),
              HasSubstr("no device of OpenNI2 with serial number or URI SN3 is connected, there are SN1"));
  for (const char* name : {"SN2", "test-2"}) {
    const auto source = camera(name);
    source->open();
    EXPECT_EQ(source->info().serial, "SN2");
  }
  const std::vector<OpenniFound> found = connected_openni(library_);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].uri, "test-2");
}

TEST_F(Openni, WhatItCannotBeUsedForIsRefused) {
  OpenniSettings settings;
  EXPECT_THAT(thrown_message([&] { OpenniCamera(settings, library_).open(); }),
              HasSubstr("the device's clock is known here by the images' arrival alone, up to 0.1 s after"));
  settings.arrival.time_uncertainty_s = 0.1;
  settings.width_px = 320;
  EXPECT_EQ(thrown_message([&] { OpenniCamera(settings, library_).open(); }),
            "no depth images of 320 x 480 pixels at 30 Hz in millimetres, there are 640 x 480 at 30 Hz");
  registered_(1);
  EXPECT_THAT(thrown_message([&] { camera()->open(); }), HasSubstr("resampled into the colour camera's view: "));
  registered_(-1);
  EXPECT_THAT(thrown_message([&] { camera()->open(); }), HasSubstr("does not say whether its depth images are"));
}

TEST_F(Openni, AFilterThatFillsHolesIsSwitchedOffOrRefused) {
  const auto open = [&] {
    const auto source = camera();
    source->open();
    return source->info().settings;
  };
  EXPECT_THAT(open(), HasSubstr("hole filter off"));
  hole_filter_(0);
  EXPECT_THAT(open(), HasSubstr("its driver says nothing of a hole filter"));
  hole_filter_(2);
  EXPECT_EQ(thrown_message([&] { (void)open(); }),
            "its hole filter stays on (1): it invents distances where the camera has none");
}

TEST_F(Openni, WhoOnlyLooksSetsNothing) {
  (void)connected_openni(library_);
  const int before = settings_();
  oni::StreamRequest request;
  request.device = "test-1";
  request.only_looks = true;
  const oni::DepthStream stream(library_, request);
  ASSERT_TRUE(stream.nominal());
  EXPECT_NEAR(stream.nominal()->fx_px, 320, 1e-3) << "a right angle";
  EXPECT_EQ(settings_(), before);
}

TEST_F(Openni, OneThatIsUnpluggedHasFailedAndComesBack) {
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got);
  unplug_(0);
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
  EXPECT_EQ(source->reason(), "was unplugged");
  source->close();
  EXPECT_EQ(thrown_message([&] { source->open(); }), "no device of OpenNI2 is connected");
  there_(1, 0);
  source->open();
  EXPECT_EQ(wait_for_reading(*source, reading), Reading::got);
}

TEST_F(Openni, SilenceIsAFailure) {
  silent_(1);
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
  EXPECT_EQ(source->reason(), "sends no image within 2 s");
}

TEST_F(Openni, ARecordingGivesEveryImageToTheBitAndBeginsAnew) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "short.oni";
  record(file, 12);
  const OpenniSpan span = openni_span(file, library_);
  EXPECT_GT(span.last_s, span.first_s);
  const auto fast = std::make_shared<const Playback>(span.first_s, span.last_s, false, Pace::as_fast_as_asked);
  OpenniRecording source(file, true, fast, library_);
  DepthReading reading;
  source.open();
  int images = 0;
  int first = 0;
  double last_s = -1;
  Reading found = Reading::got;
  while ((found = wait_for_reading(source, reading)) == Reading::got) {
    const int number = number_of(reading.depth);
    first = images == 0 ? number : first;
    EXPECT_EQ(number, first + images) << "none is left out, none changed";
    EXPECT_GT(reading.time_s, last_s);
    last_s = reading.time_s;
    ++images;
  }
  EXPECT_EQ(found, Reading::ended) << source.reason();
  EXPECT_GE(images, 10) << "OpenNI2's recorder may lose the last";
  source.close();  // OpenNI2 plays a file once at a time: who opens it again gets the same place in it
  const auto again = std::make_shared<const Playback>(span.first_s, span.last_s, true);
  OpenniRecording repeats(file, true, again, library_);
  repeats.open();
  for (int n = 0; n < images + 2; ++n) {
    ASSERT_EQ(wait_for_reading(repeats, reading), Reading::got) << repeats.reason();
    EXPECT_EQ(number_of(reading.depth), first + n % images);
    EXPECT_LE(reading.time_s, clock_now_s());
  }
  EXPECT_THAT(thrown_message([&] { (void)openni_span(folder / "none.oni", library_); }),
              HasSubstr("none.oni: is no file"));
  EXPECT_THAT(thrown_message([&] { (void)openni_span(folder.write("other.oni", "not a recording"), library_); }),
              HasSubstr("other.oni: OpenNI2: does not open: "));
}

/// A recording of a real Kinect, by OpenNI 1; its images as another program read them.
TEST_F(Openni, ARecordingOfARealKinectIsReadToTheBit) {
  const char* const data = std::getenv("DEPTHGRID_DATA");  // NOLINT(concurrency-mt-unsafe)
  const fs::path folder = fs::path(data != nullptr ? data : "../shared/data") / "raw_recordings";
  if (!fs::exists(folder / "kinect_openni.oni")) {
    GTEST_SKIP() << "there is no " << (folder / "kinect_openni.oni").string();
  }
  const OpenniSpan span = openni_span(folder / "kinect_openni.oni", library_);
  EXPECT_NEAR(span.last_s - span.first_s, 11.0 / 30, 1e-6);
  const auto fast = std::make_shared<const Playback>(span.first_s, span.last_s, false, Pace::as_fast_as_asked);
  OpenniRecording source(folder / "kinect_openni.oni", false, fast, library_);
  source.open();
  DepthReading reading;
  int images = 0;
  while (wait_for_reading(source, reading) == Reading::got) {
    if (images == 0 || images == 11) {
      const files::Gray16Image image =
          files::read_png16(folder / "decoded" / (images == 0 ? "kinect_00.png" : "kinect_11.png"));
      EXPECT_EQ(std::memcmp(image.pixels.data(), reading.depth.data, 2 * image.pixels.size()), 0) << "image " << images;
    }
    EXPECT_NEAR(reading.time_s, 0.01168 + images * 0.0333693, 1e-4);
    ++images;
  }
  EXPECT_EQ(images, 12);
}

}  // namespace
}  // namespace depthgrid::sensors
