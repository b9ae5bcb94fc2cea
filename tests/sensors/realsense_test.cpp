// RealSense cameras, by a library of the tests' own in place of librealsense2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <memory>
#include <set>
#include <string>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/realsense_camera.hpp"
#include "depthgrid/sensors/realsense_frame.hpp"
#include "depthgrid/sensors/realsense_library.hpp"
#include "depthgrid/sensors/realsense_recording.hpp"
#include "depthgrid/sensors/realsense_stream.hpp"
#include "files/temporary_folder.hpp"
#include "sensors/fake_realsense.hpp"
#include "sensors/wait_for_reading.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::sensors {
namespace {

using test::FakeCounts;
using test::FakeRealSense;
using test::thrown_message;
using ::testing::HasSubstr;
using ::testing::Not;

class RealSense : public testing::Test {
 protected:
  RealSense() {
    const SharedLibrary fake(std::vector<std::string>{FAKE_REALSENSE}, "it is built with the tests");
    fake.get("fake_realsense_set", set_);
    fake.get("fake_realsense_count", count_);
    fake.get("fake_realsense_unplug", unplug_);
    library_ = std::make_shared<const rs2::Library>(std::vector<std::string>{FAKE_REALSENSE});
    fake_.serials = {"941322070001"};
    set_(&fake_);
    settings_before_ = counts().settings;
  }
  ~RealSense() override { EXPECT_EQ(counts().objects(), 0) << "what the library handed out was not given back"; }

  void is(const std::function<void(FakeRealSense&)>& change) {
    change(fake_);
    set_(&fake_);
  }
  [[nodiscard]] FakeCounts counts() const {
    FakeCounts counts;
    count_(&counts);
    return counts;
  }
  /// What global time needs is declared where nothing is.
  [[nodiscard]] std::unique_ptr<RealSenseCamera> camera(RealSenseSettings settings = {}) const {
    if (settings.arrival.time_uncertainty_s == 0) {
      settings.arrival.time_uncertainty_s = rs2::kGlobalTimeError_s;
    }
    return std::make_unique<RealSenseCamera>(settings, library_);
  }

  std::shared_ptr<const rs2::Library> library_;
  FakeRealSense fake_;
  void (*set_)(const FakeRealSense*) = nullptr;
  void (*count_)(FakeCounts*) = nullptr;
  void (*unplug_)() = nullptr;
  int settings_before_ = 0;
};

std::uint16_t pixel(const DepthView& depth, int x, int y) {
  std::uint16_t value = 0;
  std::memcpy(&value, static_cast<const char*>(depth.data) + y * depth.stride_bytes + 2 * x, sizeof value);
  return value;
}

/// The number of the fake's frame that this is, none: another image.
long number_of(const DepthView& depth) {            // NOLINT(*runtime-int)
  for (long number = 0; number < 2000; ++number) {  // NOLINT(*runtime-int)
    if (test::fake_pixel(number, 0, 0) == pixel(depth, 0, 0)) {
      for (int y = 0; y < depth.height_px; ++y) {
        for (int x = 0; x < depth.width_px; ++x) {
          if (pixel(depth, x, y) != test::fake_pixel(number, x, y)) {
            return -1;
          }
        }
      }
      return number;
    }
  }
  return -1;
}

TEST(RealSenseLibrary, OneThatIsNotThereIsOneLineWithWhatWasTried) {
  const std::string words = thrown_message([] {
    const rs2::Library library({"librealsense2_not_there.so", "librealsense2_not_there.so.2.99",
                                "librealsense2_not_there.so.2.98", "librealsense2_not_there.so.2.13"});
  });
  EXPECT_THAT(words, HasSubstr("tried librealsense2_not_there.so, librealsense2_not_there.so.2.99 ... "
                               "librealsense2_not_there.so.2.13: install librealsense2"));
  EXPECT_EQ(words.find('\n'), std::string::npos);
  EXPECT_THAT(thrown_message([] { const rs2::Library library({"libm.so.6"}); }),
              HasSubstr("libm.so.6: has no function rs2_get_api_version"));
}

TEST_F(RealSense, TheOnlyOneIsOpenedSetUpAndRead) {
  EXPECT_EQ(counts().log_severity, rs2::kLogNone) << "the library prints";
  const auto source = camera();
  DepthReading reading;
  EXPECT_EQ(source->next(reading, 0), Reading::failed) << "not open";
  source->open();
  const SourceInfo& info = source->info();
  EXPECT_EQ(info.name, "Intel RealSense D435");
  EXPECT_EQ(info.serial, "941322070001");
  EXPECT_EQ(info.settings, "preset 3, emitter 1, emitter on and off 0, global time 1, laser power 150");
  EXPECT_EQ(info.metres_per_unit, 0.001);
  ASSERT_TRUE(info.intrinsics);
  EXPECT_EQ(info.intrinsics->cx_px, 320) << "their centres are at 0, ours at a half";
  EXPECT_EQ(info.intrinsics->fy_px, 386);
  double last_s = 0;
  long last = -1;  // NOLINT(*runtime-int)
  for (int n = 0; n < 5; ++n) {
    ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
    const long number = number_of(reading.depth);  // NOLINT(*runtime-int)
    EXPECT_GT(number, last);
    EXPECT_EQ(reading.skipped, number - last - 1);
    last = number;
    EXPECT_GT(reading.time_s, last_s);
    last_s = reading.time_s;
    // Exposed 30 ms before it arrived; this computer may be slow, never too quick.
    EXPECT_LT(reading.time_s, clock_now_s() - 0.029);
  }
  EXPECT_EQ(info.clock, "the device, as librealsense2 converts it to this computer's");
}

TEST_F(RealSense, GlobalTimeIsRefusedUnlessItsErrorIsDeclared) {
  RealSenseCamera source({}, library_);
  source.open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(source, reading), Reading::failed);
  EXPECT_THAT(std::string(source.reason()),
              HasSubstr("is off by some milliseconds: margins: {time_uncertainty_s: 0.005}"));
}

TEST_F(RealSense, AStampAfterTheArrivalIsNotBelieved) {
  is([](FakeRealSense& fake) { fake.stamp_off_s = 10; });
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
  EXPECT_LT(reading.time_s, clock_now_s() - 0.0039) << "half the exposure";
}

TEST_F(RealSense, ImagesBeforeGlobalTimeBeginsArePassedOver) {
  is([](FakeRealSense& fake) { fake.hardware_first = 20; });
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
  EXPECT_EQ(source->info().clock, "the device, as librealsense2 converts it to this computer's");
  EXPECT_GE(reading.skipped, 20);
}

TEST_F(RealSense, WhereNothingIsSaidOfTheExposureAWholePeriodIsTakenOff) {
  is([](FakeRealSense& fake) { fake.has_metadata = false; });
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got);
  EXPECT_LT(reading.time_s, clock_now_s() - 0.051) << "30 ms for the way, 12 ms for the stamp, less 33";
}

TEST_F(RealSense, ASlowReaderGetsTheNewestImageAndWhatItMissedIsCounted) {
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got);
  const long first = number_of(reading.depth);  // NOLINT(*runtime-int)
  const int sent = counts().sent;
  while (counts().sent < sent + 5) {
    (void)wait_until(clock_now_s() + 0.01, 1);
  }
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got);
  EXPECT_GE(reading.skipped, 3) << "but for one that was being handed over";
  EXPECT_EQ(number_of(reading.depth), first + 1 + reading.skipped);
}

TEST_F(RealSense, WhichOneItIsHasToBeKnown) {
  const auto refused = [&](const std::string& serial) {
    RealSenseSettings settings;
    settings.serial = serial;
    return thrown_message([&] { camera(settings)->open(); });
  };
  is([](FakeRealSense& fake) { fake.serials.clear(); });
  EXPECT_EQ(refused(""), "no RealSense is connected");
  is([](FakeRealSense& fake) { fake.serials = {"111", "222"}; });
  EXPECT_EQ(
      refused(""),
      "2 RealSense are connected, serial: says which one: 111 (Intel RealSense D435), 222 (Intel RealSense D435)");
  EXPECT_EQ(refused("333"),
            "no RealSense with serial number 333 is connected, there are 111 (Intel RealSense D435), "
            "222 (Intel RealSense D435)");
  EXPECT_EQ(refused("222"), "");
  RealSenseSettings settings;
  settings.serial = "222";
  const auto source = camera(settings);
  source->open();
  EXPECT_EQ(source->info().serial, "222");
}

TEST_F(RealSense, OneThatAnotherProgramHoldsDoesNotKeepTheOthersFromOpening) {
  is([](FakeRealSense& fake) {
    fake.serials = {"111", "222"};
    fake.held = "111";
  });
  RealSenseSettings settings;
  settings.serial = "222";
  const auto source = camera(settings);
  source->open();
  EXPECT_EQ(source->info().serial, "222");
  settings.serial = "111";
  EXPECT_EQ(thrown_message([&] { camera(settings)->open(); }),
            "no RealSense with serial number 111 is connected, there are one that does not open (librealsense2: Device "
            "or resource busy), 222 (Intel RealSense D435)");
}

TEST_F(RealSense, ASizeThatItHasNotIsRefusedWithThoseThatItHas) {
  RealSenseSettings settings;
  settings.width_px = 641;
  EXPECT_EQ(thrown_message([&] { camera(settings)->open(); }),
            "no depth images of 641 x 480 pixels at 30 Hz, there are 640 x 480 at 15, 30 Hz; 848 x 480 at 30 Hz; it is "
            "connected by USB 3.2");
}

TEST_F(RealSense, ALensThatDistortsIsRefused) {
  is([](FakeRealSense& fake) { fake.distorts = true; });
  EXPECT_THAT(thrown_message([&] { camera()->open(); }), HasSubstr("the lens distorts its depth images"));
}

TEST_F(RealSense, WhatItDoesNotTakeIsSaid) {
  is([](FakeRealSense& fake) { fake.ignored_option = 18; });
  {
    const auto source = camera();
    source->open();
    EXPECT_EQ(source->info().settings,
              "preset 3, emitter on and off 0, global time 1, laser power 150; not set: emitter 0 in place of 1");
  }
  is([](FakeRealSense& fake) { fake.last_option = 53; });
  {
    const auto source = camera();
    source->open();
    EXPECT_THAT(source->info().settings, HasSubstr("alternating exposures (librealsense2: invalid enum value)"))
        << "a library that does not know it";
  }
  const auto refused = [&] { return thrown_message([&] { camera()->open(); }); };
  is([](FakeRealSense& fake) { fake.ignored_option = 46; });
  EXPECT_THAT(refused(), HasSubstr("does not take what decides what its readings mean: emitter on and off 1 in place "
                                   "of 0: close what else sets it"));
  is([](FakeRealSense& fake) { fake.refuses_preset = true; });
  EXPECT_THAT(refused(), HasSubstr("preset (librealsense2: hwmon command failed), emitter on and off 1 in place of 0"));
}

TEST_F(RealSense, WhoOnlyLooksSetsNothing) {
  rs2::StreamRequest request;
  request.only_looks = true;
  const rs2::Stream stream(library_, request);
  EXPECT_EQ(stream.intrinsics().fy_px, 386);
  EXPECT_EQ(counts().settings, settings_before_);
}

TEST_F(RealSense, OneThatIsUnpluggedHasFailedAndComesBack) {
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got);
  unplug_();
  ASSERT_EQ(source->next(reading, 0.1), Reading::failed);
  EXPECT_EQ(source->reason(), "was unplugged");
  source->close();
  EXPECT_EQ(thrown_message([&] { source->open(); }), "no RealSense is connected");
  set_(&fake_);
  source->open();
  EXPECT_EQ(wait_for_reading(*source, reading), Reading::got);
}

TEST_F(RealSense, SilenceIsAFailure) {
  is([](FakeRealSense& fake) { fake.is_silent = true; });
  const auto source = camera();
  source->open();
  DepthReading reading;
  EXPECT_EQ(source->next(reading, 0.05), Reading::nothing);
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
  EXPECT_EQ(source->reason(), "sends no image within 2 s");
}

TEST_F(RealSense, ErrorsOfTheLibraryAreTold) {
  is([](FakeRealSense& fake) { fake.start_error = "Device or resource busy"; });
  EXPECT_EQ(thrown_message([&] { camera()->open(); }), "librealsense2: Device or resource busy");
  is([](FakeRealSense& fake) {
    fake.start_error.clear();
    fake.frames_have_errors = true;
  });
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
  EXPECT_EQ(source->reason(), "librealsense2: frame was\\nlost") << "one line";
}

TEST_F(RealSense, AnotherSizeInMidRunIsAFailure) {
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got);
  is([](FakeRealSense& fake) { fake.frame_width = 320; });
  Reading found = Reading::got;
  while (found == Reading::got) {
    found = wait_for_reading(*source, reading);
  }
  EXPECT_EQ(found, Reading::failed);
  EXPECT_THAT(std::string(source->reason()),
              HasSubstr("sends an image of 320 x 480 pixels of 16 bits, 640 bytes a row, in place of 640 x 480"));
}

TEST_F(RealSense, AnExposureLongerThanDeclaredIsAFailure) {
  RealSenseSettings settings;
  settings.longest_exposure_s = 0.008;
  DepthReading reading;
  {
    const auto source = camera(settings);
    source->open();
    EXPECT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
  }
  settings.longest_exposure_s = 0.007;
  const auto source = camera(settings);
  source->open();
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
  EXPECT_THAT(std::string(source->reason()), HasSubstr("exposes for 0.008 s"));
}

TEST_F(RealSense, StampsOfTheArrivalAreRefusedUnlessTheirLagIsDeclared) {
  is([](FakeRealSense& fake) { fake.domain = rs2::kSystemTime; });
  DepthReading reading;
  {
    const auto source = camera();
    source->open();
    ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
    EXPECT_THAT(std::string(source->reason()), HasSubstr("it stamps images when they arrive, up to 0.1 s after"));
  }
  RealSenseSettings settings;
  settings.arrival.time_uncertainty_s = 0.1;
  {
    const auto source = camera(settings);
    source->open();
    ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
    EXPECT_EQ(source->info().clock, "this computer, when images arrive");
  }
  for (const double lag_s : {0.0, 0.03, 0.09}) {
    settings.arrival = {.lag_s = lag_s, .time_uncertainty_s = 0.009};
    const auto source = camera(settings);
    source->open();
    ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed) << "an image may have been under way for longer";
    EXPECT_THAT(std::string(source->reason()), HasSubstr("must be 0.1 together; the cell says "));
  }
  settings.arrival = {.lag_s = 0.09, .time_uncertainty_s = 0.01};
  const auto source = camera(settings);
  source->open();
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
  EXPECT_LT(reading.time_s, clock_now_s() - 0.089) << "the lag is taken off";
}

TEST_F(RealSense, TheDevicesOwnClockIsFollowedByTheArrivals) {
  is([](FakeRealSense& fake) { fake.domain = rs2::kHardwareClock; });
  DepthReading reading;
  {
    const auto source = camera();
    source->open();
    ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
    EXPECT_THAT(std::string(source->reason()),
                HasSubstr("the device's clock is known here by the images' arrival alone"));
  }
  RealSenseSettings settings;
  settings.arrival = {.lag_s = 0.03, .time_uncertainty_s = 0.07};
  const auto source = camera(settings);
  source->open();
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
  EXPECT_GE(reading.skipped, DeviceClock::kImages - 1) << "the first ones only say how the clocks stand";
  EXPECT_EQ(source->info().clock, "the device, by the images' arrival");
  is([](FakeRealSense& fake) { fake.stall_s = 0.3; });
  for (int n = 0; n < 3; ++n) {  // the first of them may have been under way before
    ASSERT_EQ(wait_for_reading(*source, reading), Reading::got) << source->reason();
  }
  EXPECT_LT(reading.time_s, clock_now_s() - 0.3) << "an image that is late does not look newer";
}

TEST_F(RealSense, AClockThatChangesInMidRunIsAFailure) {
  const auto source = camera();
  source->open();
  DepthReading reading;
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::got);
  is([](FakeRealSense& fake) { fake.domain = rs2::kSystemTime; });
  Reading found = Reading::got;
  while (found == Reading::got) {
    found = wait_for_reading(*source, reading);
  }
  EXPECT_EQ(found, Reading::failed);
  EXPECT_THAT(std::string(source->reason()), HasSubstr("another clock in mid-run"));
  source->close();
  is([](FakeRealSense& fake) { fake.domain = 7; });
  source->open();
  ASSERT_EQ(wait_for_reading(*source, reading), Reading::failed);
  EXPECT_THAT(std::string(source->reason()), HasSubstr("a clock that is not known here (domain 7)"));
}

constexpr ArrivalTimes kDeclared{.lag_s = {}, .time_uncertainty_s = rs2::kGlobalTimeError_s};

TEST_F(RealSense, TimesOfARecordingAreByTheRulesOfACamera) {
  const test::TemporaryFolder folder;
  const auto file = folder / "short.bag";
  std::ofstream(file) << "fakebag 3\n";
  const auto refused = [&] { return thrown_message([&] { (void)realsense_span(file, {}, library_); }); };
  EXPECT_THAT(refused(), HasSubstr("short.bag: librealsense2's conversion of the device's clock"));
  is([](FakeRealSense& fake) { fake.domain = rs2::kSystemTime; });
  EXPECT_THAT(refused(), HasSubstr("it stamps images when they arrive, up to 0.1 s after"));
  const ArrivalTimes late{.lag_s = 0.1, .time_uncertainty_s = 0};
  const RealSenseSpan span = realsense_span(file, late, library_);
  EXPECT_NEAR(span.first_s, 1.7e9 + 100 + 0.03 - 0.1, 1e-3);
  const auto playback = std::make_shared<const Playback>(span.first_s, span.last_s, false, Pace::as_fast_as_asked);
  DepthReading reading;
  {
    RealSenseRecording source(file, playback, late, library_);
    source.open();
    ASSERT_EQ(wait_for_reading(source, reading), Reading::got) << source.reason();
    EXPECT_NEAR(reading.time_s, playback->clock_s(1.7e9 + 100 + 0.03 - 0.1, 0), 1e-3);
  }
  {
    RealSenseRecording source(file, playback, {}, library_);
    source.open();
    EXPECT_EQ(wait_for_reading(source, reading), Reading::failed);
  }
  is([](FakeRealSense& fake) {
    fake.domain = rs2::kHardwareClock;
    fake.has_metadata = false;
  });
  EXPECT_NEAR(realsense_span(file, {}, library_).first_s, 100 + 0.012 - 1.0 / 15, 1e-3) << "a whole period";
}

TEST_F(RealSense, ARecordingGivesEveryImageInItsOrder) {
  const test::TemporaryFolder folder;
  const auto file = folder / "short.bag";
  std::ofstream(file) << "fakebag 30\n";
  is([](FakeRealSense& fake) { fake.domain = rs2::kHardwareClock; });
  const RealSenseSpan span = realsense_span(file, kDeclared, library_);
  EXPECT_NEAR(span.first_s, 100, 1e-3);
  EXPECT_NEAR(span.last_s - span.first_s, 1, 1e-6);
  EXPECT_TRUE(span.has_own_clock);
  EXPECT_EQ(span.info.serial, "recorded");
  const auto playback = std::make_shared<const Playback>(span.first_s, span.last_s, false, Pace::as_fast_as_asked);
  RealSenseRecording source(file, playback, kDeclared, library_);
  DepthReading reading;
  EXPECT_EQ(source.next(reading, 0), Reading::failed);
  source.open();
  for (int n = 0; n < 30; ++n) {
    ASSERT_EQ(wait_for_reading(source, reading), Reading::got) << source.reason();
    EXPECT_EQ(number_of(reading.depth), n);
    EXPECT_NEAR(reading.time_s, 100 + n / 30.0, 1e-3) << "the middle of the exposure";
  }
  EXPECT_EQ(wait_for_reading(source, reading), Reading::ended);
  EXPECT_EQ(wait_for_reading(source, reading), Reading::ended);
  EXPECT_THAT(thrown_message([&] { (void)realsense_span(folder / "none.bag", kDeclared, library_); }),
              HasSubstr("none.bag: is no file"));
  std::ofstream(folder / "other.bag") << "ROSBAG\n";
  EXPECT_THAT(thrown_message([&] { (void)realsense_span(folder / "other.bag", kDeclared, library_); }),
              HasSubstr("other.bag: librealsense2: not a bag file"));
}

// What a library that hands over a frame too late is made of: the frame is held back.
rs2::OnFrame late_call = nullptr;
void* late_user = nullptr;
rs2::Frame* late_frame = nullptr;

void hold_one_back(rs2::Frame* frame, void* user) {
  if (late_frame == nullptr) {
    late_frame = frame;
    late_user = user;
    return;
  }
  late_call(frame, user);
}

void (*real_start)(const rs2::Sensor*, rs2::OnFrame, void*, rs2::ErrorObject**) = nullptr;
void (*real_stop)(const rs2::Sensor*, rs2::ErrorObject**) = nullptr;
const char* (*real_info)(const rs2::Device*, int, rs2::ErrorObject**) = nullptr;

TEST_F(RealSense, AFrameThatComesAfterTheEndIsGivenBack) {
  rs2::Functions functions = library_->functions();
  real_start = functions.start;
  real_stop = functions.stop;
  real_info = functions.get_device_info;
  functions.start = [](const rs2::Sensor* sensor, rs2::OnFrame call, void* user, rs2::ErrorObject** error) {
    late_call = call;
    real_start(sensor, &hold_one_back, user, error);
  };
  functions.stop = [](const rs2::Sensor* sensor, rs2::ErrorObject** error) {
    real_stop(sensor, error);
    (void)real_info(nullptr, 99, error);  // fails
  };
  const auto held = std::make_shared<const rs2::Library>(functions, "one that is late");
  const test::TemporaryFolder folder;
  const auto file = folder / "short.bag";
  std::ofstream(file) << "fakebag 3\n";
  for (const bool is_recording : {true, false}) {
    late_frame = nullptr;
    {
      rs2::StreamRequest request;
      request.any_size = is_recording;
      request.file = is_recording ? file.string() : "";
      rs2::Stream stream(held, request);
      stream.start();
      EXPECT_NE(stream.take(20), nullptr);
    }
    const int frames = counts().frames;
    late_call(late_frame, late_user);
    EXPECT_EQ(counts().frames, frames - 1) << (is_recording ? "recording" : "device");
  }
}

TEST_F(RealSense, ARecordingKeepsItsPaceAndBeginsAnew) {
  const test::TemporaryFolder folder;
  const auto file = folder / "short.bag";
  std::ofstream(file) << "fakebag 6\n";
  const RealSenseSpan span = realsense_span(file, kDeclared, library_);
  const auto playback = std::make_shared<const Playback>(span.first_s, span.last_s, true);
  RealSenseRecording source(file, playback, kDeclared, library_);
  source.open();
  DepthReading reading;
  std::int64_t images = 0;
  double last_s = 0;
  while (images < 12) {
    ASSERT_EQ(wait_for_reading(source, reading), Reading::got) << source.reason();
    EXPECT_LE(reading.time_s, clock_now_s());
    EXPECT_GT(reading.time_s, last_s);
    EXPECT_EQ(number_of(reading.depth), (images + reading.skipped) % 6);
    last_s = reading.time_s;
    images += 1 + reading.skipped;
  }
}

TEST(DeviceClock, FollowsTheLeastDelay) {
  DeviceClock clock(0.01);
  double worst_s = 0;
  for (int n = 0; n < 900; ++n) {
    const double exposed_s = 1000 + n / 30.0;
    const double arrival_s = exposed_s + 0.01 + (n % 7) * 0.004;
    const double device_s = (exposed_s - 990) * (1 - 50e-6);  // a clock that is slow
    const double time_s = clock.clock_s(device_s, arrival_s);
    if (clock.is_settled()) {
      EXPECT_LE(time_s, exposed_s + 1e-9) << "never newer than it is, at image " << n;
      worst_s = std::max(worst_s, exposed_s - time_s);
    }
  }
  EXPECT_LT(worst_s, 0.0006);
}

TEST(DeviceClock, BeginsAnewWithTheDevice) {
  DeviceClock clock(0);
  for (int n = 0; n < 20; ++n) {
    (void)clock.clock_s(n / 30.0, 50 + n / 30.0);
  }
  EXPECT_TRUE(clock.is_settled());
  EXPECT_DOUBLE_EQ(clock.clock_s(0.1, 60), 60);
  EXPECT_FALSE(clock.is_settled());
}

TEST(Unwrapped32, GoesOnBeyondTheLastNumber) {
  Unwrapped32 counter;
  EXPECT_EQ(counter.next(0xFFFFFFF0U), 0xFFFFFFF0LL);
  EXPECT_EQ(counter.next(0x10U), 0x100000010LL);
  EXPECT_EQ(counter.next(0x8U), 0x100000008LL) << "a step back stays one";
}

}  // namespace
}  // namespace depthgrid::sensors
