// A driver for OpenNI2: two devices without hardware, for the tests of the source that reads them.
#include <atomic>
#include <chrono>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <thread>

#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)

#include <Driver/OniDriverAPI.h>
#include <OniCAPI.h>

#include "depthgrid/sensors/openni_library.hpp"

// What the source declares of OpenNI2 is as OpenNI2 declares it.
namespace oni_here = depthgrid::sensors::oni;
static_assert(oni_here::kVersion == ONI_API_VERSION);
static_assert(sizeof(oni_here::Frame) == sizeof(OniFrame));
static_assert(offsetof(oni_here::Frame, timestamp_us) == offsetof(OniFrame, timestamp));
static_assert(offsetof(oni_here::Frame, mode) == offsetof(OniFrame, videoMode));
static_assert(offsetof(oni_here::Frame, stride) == offsetof(OniFrame, stride));
static_assert(sizeof(oni_here::DeviceInfo) == sizeof(OniDeviceInfo));
static_assert(sizeof(oni_here::VideoMode) == sizeof(OniVideoMode));
static_assert(sizeof(oni_here::SensorInfo) == sizeof(OniSensorInfo));
static_assert(sizeof(oni_here::DeviceCallbacks) == sizeof(OniDeviceCallbacks));

// NOLINTBEGIN: the shape of a driver is OpenNI2's.

namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr double kHalfPi = 1.57079632679;

std::atomic<int> registered{0};
std::atomic<bool> is_silent{false};
std::atomic<bool> starts_mirrored{true};
std::atomic<int> hole_filter{1};  ///< 1: on until it is set, 2: stays on, 0: the driver knows none
std::atomic<int> settings{0};     ///< how often a property was set

class TestStream final : public oni::driver::StreamBase {
 public:
  ~TestStream() override { stop(); }
  OniStatus start() override {
    runs_ = true;
    thread_ = std::thread([this] {
      for (int number = 1; runs_; ++number) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (!is_silent) {
          send(number);
        }
      }
    });
    return ONI_STATUS_OK;
  }
  void stop() override {
    runs_ = false;
    if (thread_.joinable()) {
      thread_.join();
    }
  }
  OniBool isPropertySupported(int what) override {
    // Without the last two a recording of this stream plays no image.
    return what == ONI_STREAM_PROPERTY_VIDEO_MODE || what == ONI_STREAM_PROPERTY_HORIZONTAL_FOV ||
           what == ONI_STREAM_PROPERTY_VERTICAL_FOV || what == ONI_STREAM_PROPERTY_MAX_VALUE ||
           what == ONI_STREAM_PROPERTY_MIRRORING || what == ONI_STREAM_PROPERTY_STRIDE ||
           what == ONI_STREAM_PROPERTY_CROPPING;
  }
  OniStatus getProperty(int what, void* data, int* size) override {
    switch (what) {
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return give(mode_, data, size);
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
        return give(static_cast<float>(kHalfPi), data, size);
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return give(1.2F, data, size);
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return give(10000, data, size);
      case ONI_STREAM_PROPERTY_MIRRORING:
        return give(static_cast<OniBool>(mirrored_), data, size);
      case ONI_STREAM_PROPERTY_STRIDE:
        return give(2 * kWidth, data, size);
      case ONI_STREAM_PROPERTY_CROPPING:
        return give(OniCropping{}, data, size);
      case oni_here::kHoleFilter:
        return hole_filter == 0 ? ONI_STATUS_NOT_SUPPORTED : give(holes_, data, size);
      default:
        return ONI_STATUS_NOT_SUPPORTED;
    }
  }
  OniStatus setProperty(int what, const void* data, int size) override {
    ++settings;
    if (what == oni_here::kHoleFilter && hole_filter == 1 && size == static_cast<int>(sizeof holes_)) {
      std::memcpy(&holes_, data, sizeof holes_);
      return ONI_STATUS_OK;
    }
    if (what == ONI_STREAM_PROPERTY_VIDEO_MODE && size == static_cast<int>(sizeof mode_)) {
      OniVideoMode wanted;
      std::memcpy(&wanted, data, sizeof wanted);
      return wanted.resolutionX == kWidth && wanted.resolutionY == kHeight && wanted.fps == 30
                 ? ONI_STATUS_OK
                 : ONI_STATUS_NOT_SUPPORTED;
    }
    if (what == ONI_STREAM_PROPERTY_MIRRORING && !starts_mirrored) {
      std::memcpy(&mirrored_, data, sizeof mirrored_);
      return ONI_STATUS_OK;
    }
    return ONI_STATUS_NOT_SUPPORTED;
  }
  void notifyAllProperties() override {
    const OniCropping none{};
    const int stride = 2 * kWidth;
    const int most = 10000;
    const float across = static_cast<float>(kHalfPi);
    const float down = 1.2F;
    raisePropertyChanged(ONI_STREAM_PROPERTY_VIDEO_MODE, &mode_, sizeof mode_);
    raisePropertyChanged(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, &across, sizeof across);
    raisePropertyChanged(ONI_STREAM_PROPERTY_VERTICAL_FOV, &down, sizeof down);
    raisePropertyChanged(ONI_STREAM_PROPERTY_MAX_VALUE, &most, sizeof most);
    raisePropertyChanged(ONI_STREAM_PROPERTY_STRIDE, &stride, sizeof stride);
    raisePropertyChanged(ONI_STREAM_PROPERTY_CROPPING, &none, sizeof none);
    raisePropertyChanged(ONI_STREAM_PROPERTY_MIRRORING, &mirrored_, sizeof mirrored_);
  }

 private:
  template <class Value>
  static OniStatus give(const Value& value, void* data, int* size) {
    if (*size != static_cast<int>(sizeof value)) {
      return ONI_STATUS_BAD_PARAMETER;
    }
    std::memcpy(data, &value, sizeof value);
    return ONI_STATUS_OK;
  }
  void send(int number) {
    OniFrame* frame = getServices().acquireFrame();
    if (frame == nullptr) {
      return;
    }
    auto* pixels = static_cast<unsigned short*>(frame->data);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        pixels[y * kWidth + (mirrored_ ? kWidth - 1 - x : x)] =
            static_cast<unsigned short>(500 + (7 * number + x + 3 * y) % 2000);
      }
    }
    frame->frameIndex = number;
    frame->timestamp = static_cast<uint64_t>(number) * 33333;
    frame->videoMode = mode_;
    frame->width = kWidth;
    frame->height = kHeight;
    frame->stride = 2 * kWidth;
    frame->dataSize = 2 * kWidth * kHeight;
    frame->cropOriginX = 0;
    frame->cropOriginY = 0;
    frame->croppingEnabled = FALSE;
    frame->sensorType = ONI_SENSOR_DEPTH;
    raiseNewFrame(frame);
    getServices().releaseFrame(frame);
  }

  OniVideoMode mode_{ONI_PIXEL_FORMAT_DEPTH_1_MM, kWidth, kHeight, 30};
  OniBool mirrored_ = TRUE;
  unsigned long long holes_ = 1;
  std::atomic<bool> runs_{false};
  std::thread thread_;
};

class TestDevice final : public oni::driver::DeviceBase {
 public:
  explicit TestDevice(const char* uri) : serial_(uri + std::strlen("test-")) {}
  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = &sensor_;
    *count = 1;
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType type) override {
    return type == ONI_SENSOR_DEPTH ? new TestStream : nullptr;
  }
  void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }
  OniBool isPropertySupported(int what) override {
    return what == ONI_DEVICE_PROPERTY_SERIAL_NUMBER || what == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
  }
  OniStatus getProperty(int what, void* data, int* size) override {
    if (what == ONI_DEVICE_PROPERTY_SERIAL_NUMBER) {
      std::snprintf(static_cast<char*>(data), static_cast<std::size_t>(*size), "SN%s", serial_);
      return ONI_STATUS_OK;
    }
    if (what == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) {
      const int now = registered;
      if (now < 0) {
        return ONI_STATUS_ERROR;
      }
      std::memcpy(data, &now, sizeof now);
      return ONI_STATUS_OK;
    }
    return ONI_STATUS_NOT_SUPPORTED;
  }

 private:
  const char* serial_;
  OniVideoMode modes_[2] = {{ONI_PIXEL_FORMAT_DEPTH_1_MM, kWidth, kHeight, 30},
                            {ONI_PIXEL_FORMAT_SHIFT_9_2, kWidth, kHeight, 30}};
  OniSensorInfo sensor_{ONI_SENSOR_DEPTH, 2, modes_};
};

class TestDriver;
TestDriver* driver = nullptr;

class TestDriver final : public oni::driver::DriverBase {
 public:
  explicit TestDriver(OniDriverServices* services) : DriverBase(services) { driver = this; }
  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    plug(0);
    plug(1);
    return ONI_STATUS_OK;
  }
  oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override { return new TestDevice(uri); }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
  void shutdown() override { driver = nullptr; }

  void plug(int which) {
    if (is_there_[which]) {
      deviceConnected(&infos_[which]);
    }
  }
  void unplug(int which) { deviceDisconnected(&infos_[which]); }
  static bool is_there_[2];

 private:
  OniDeviceInfo infos_[2] = {{"test-1", "Tests", "Depth", 1, 1}, {"test-2", "Tests", "Depth", 1, 2}};
};

bool TestDriver::is_there_[2] = {true, false};

}  // namespace

extern "C" {
void test_openni_there(int first, int second) {
  const bool wanted[2] = {first != 0, second != 0};
  for (int which = 0; which < 2; ++which) {
    const bool was = TestDriver::is_there_[which];
    TestDriver::is_there_[which] = wanted[which];
    if (driver != nullptr && was != wanted[which]) {
      was ? driver->unplug(which) : driver->plug(which);
    }
  }
}
void test_openni_unplug(int which) {
  test_openni_there(which != 0 && TestDriver::is_there_[0], which != 1 && TestDriver::is_there_[1]);
}
void test_openni_silent(int silent) { is_silent = silent != 0; }
/// Negative: the device does not say it.
void test_openni_registered(int is) { registered = is; }
void test_openni_hole_filter(int is) { hole_filter = is; }
int test_openni_settings() { return settings; }
/// Whether the device stays mirrored, whatever is asked for.
void test_openni_mirrored(int stays) { starts_mirrored = stays != 0; }
}

ONI_EXPORT_DRIVER(TestDriver)

// NOLINTEND
