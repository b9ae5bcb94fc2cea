#include "fake_realsense.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "depthgrid/sensors/realsense_library.hpp"

// NOLINTBEGIN: an interface in C, as its makers wrote it, with owners by hand.

namespace {

using depthgrid::sensors::rs2::Intrinsics;
using depthgrid::test::fake_pixel;
using depthgrid::test::FakeCounts;
using depthgrid::test::FakeRealSense;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr double kPeriod_s = 0.01;

struct FakeError {
  std::string words;
};
struct FakeContext {
  void (*changed)(struct FakeList*, struct FakeList*, void*) = nullptr;
  void* user = nullptr;
};
struct FakeDevice {
  std::string serial;
  std::string file;
  std::shared_ptr<std::atomic<int>> status = std::make_shared<std::atomic<int>>(3);
  int frames = 0;
};
struct FakeList {
  std::vector<std::string> serials;
};
struct FakeFrame {
  long number;
  double stamp_ms;
  long stamp_us;
  int width;
  FakeRealSense as;
  std::vector<unsigned short> pixels;
  int domain;
};
struct FakeSensor {
  FakeDevice device;
  float options[128] = {};
  bool is_open = false;
  std::atomic<bool> runs{false};
  std::thread thread;
};

std::mutex mutex;
FakeRealSense wanted;
std::atomic<int> domain_now{2};
std::atomic<int> width_now{kWidth};
std::atomic<bool> silent_now{false};
FakeCounts counts;
std::vector<FakeContext*> contexts;

void count(int FakeCounts::*what, int by) {
  const std::scoped_lock lock(mutex);
  counts.*what += by;
}

FakeRealSense now() {
  const std::scoped_lock lock(mutex);
  return wanted;
}

template <class Work>
auto guarded(void** error, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& why) {
    count(&FakeCounts::errors, 1);
    *error = new FakeError{why.what()};
    return decltype(work())();
  }
}

const char* environment_serials() { return std::getenv("FAKE_REALSENSE_SERIALS"); }

std::vector<std::string> plugged() {
  const char* given = environment_serials();
  if (given == nullptr) {
    return now().serials;
  }
  std::vector<std::string> serials;
  std::istringstream text(given);
  for (std::string serial; text >> serial;) {
    serials.push_back(serial);
  }
  return serials;
}

double system_now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

FakeFrame* frame_of(long number, double exposed_s) {
  count(&FakeCounts::frames, 1);
  auto* frame = new FakeFrame;
  frame->number = number;
  frame->as = now();
  frame->domain = number < frame->as.hardware_first ? 0 : domain_now.load();
  frame->width = width_now;
  const double stamp_s =
      exposed_s + frame->as.stamp_off_s + (frame->domain == 1 ? frame->as.arrival_late_s : frame->as.stamp_late_s);
  frame->stamp_ms = 1e3 * (frame->domain == 0 ? stamp_s - 1.7e9 : stamp_s);
  frame->stamp_us = static_cast<long>(1e6 * (stamp_s - 1.7e9));
  frame->pixels.resize(static_cast<std::size_t>(frame->width) * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < frame->width; ++x) {
      frame->pixels[static_cast<std::size_t>(y) * frame->width + x] = fake_pixel(number, x, y);
    }
  }
  return frame;
}

}  // namespace

extern "C" {

void fake_realsense_set(const FakeRealSense* as) {
  const std::scoped_lock lock(mutex);
  wanted = *as;
  domain_now = as->domain;
  width_now = as->frame_width;
  silent_now = as->is_silent;
}
void fake_realsense_count(FakeCounts* into) {
  const std::scoped_lock lock(mutex);
  *into = counts;
}
void fake_realsense_unplug() {
  std::vector<FakeContext> told;
  FakeList removed;
  {
    const std::scoped_lock lock(mutex);
    removed.serials.swap(wanted.serials);
    for (const FakeContext* context : contexts) {
      told.push_back(*context);
    }
  }
  silent_now = true;
  for (const FakeContext& context : told) {
    if (context.changed != nullptr) {
      count(&FakeCounts::lists, 2);
      context.changed(new FakeList(removed), new FakeList, context.user);
    }
  }
}

int rs2_get_api_version(void**) { return 25600; }
const char* rs2_get_error_message(const void* error) { return static_cast<const FakeError*>(error)->words.c_str(); }
void rs2_free_error(void* error) {
  count(&FakeCounts::errors, -1);
  delete static_cast<FakeError*>(error);
}
void rs2_log_to_console(int severity, void**) {
  const std::scoped_lock lock(mutex);
  counts.log_severity = severity;
}
void* rs2_create_context(int version, void** error) {
  return guarded(error, [&]() -> void* {
    if (version != 25600) {
      throw std::runtime_error("API version mismatch");
    }
    count(&FakeCounts::contexts, 1);
    auto* context = new FakeContext;
    const std::scoped_lock lock(mutex);
    contexts.push_back(context);
    return context;
  });
}
void rs2_delete_context(void* context) {
  count(&FakeCounts::contexts, -1);
  const std::scoped_lock lock(mutex);
  contexts.erase(std::find(contexts.begin(), contexts.end(), context));
  delete static_cast<FakeContext*>(context);
}
void* rs2_query_devices(const void*, void**) {
  count(&FakeCounts::lists, 1);
  return new FakeList{plugged()};
}
void* rs2_context_add_device(void*, const char* file, void** error) {
  return guarded(error, [&]() -> void* {
    std::ifstream in(file);
    std::string word;
    auto device = std::make_unique<FakeDevice>();
    if (!(in >> word >> device->frames) || word != "fakebag") {
      throw std::runtime_error("not a bag file");
    }
    device->serial = "recorded";
    device->file = file;
    count(&FakeCounts::devices, 1);
    return device.release();
  });
}
void rs2_set_devices_changed_callback(const void* context, void (*changed)(FakeList*, FakeList*, void*), void* user,
                                      void**) {
  const std::scoped_lock lock(mutex);
  auto* const of = const_cast<FakeContext*>(static_cast<const FakeContext*>(context));
  of->changed = changed;
  of->user = user;
}
int rs2_get_device_count(const void* list, void**) {
  return static_cast<int>(static_cast<const FakeList*>(list)->serials.size());
}
int rs2_device_list_contains(const void* list, const void* device, void**) {
  const auto& serials = static_cast<const FakeList*>(list)->serials;
  return std::count(serials.begin(), serials.end(), static_cast<const FakeDevice*>(device)->serial) > 0 ? 1 : 0;
}
void* rs2_create_device(const void* list, int index, void** error) {
  return guarded(error, [&]() -> void* {
    const std::string serial = static_cast<const FakeList*>(list)->serials.at(static_cast<std::size_t>(index));
    if (serial == now().held) {
      throw std::runtime_error("Device or resource busy");
    }
    count(&FakeCounts::devices, 1);
    auto* device = new FakeDevice;
    device->serial = serial;
    return device;
  });
}
void rs2_delete_device_list(void* list) {
  count(&FakeCounts::lists, -1);
  delete static_cast<FakeList*>(list);
}
void rs2_delete_device(void* device) {
  count(&FakeCounts::devices, -1);
  delete static_cast<FakeDevice*>(device);
}
int rs2_supports_device_info(const void* device, int what, void** error) {
  return guarded(error, [&]() -> int {
    if (device == nullptr) {
      throw std::runtime_error("null pointer passed for argument \"dev\"");
    }
    return what == 0 || what == 1 || what == 9 ? 1 : 0;
  });
}
const char* rs2_get_device_info(const void* device, int what, void** error) {
  return guarded(error, [&]() -> const char* {
    switch (what) {
      case 0:
        return "Intel RealSense D435";
      case 1:
        return static_cast<const FakeDevice*>(device)->serial.c_str();
      case 9:
        return "3.2";
      default:
        throw std::runtime_error("info is not supported");
    }
  });
}

// The first sensor is one of colour.
void* rs2_query_sensors(const void* device, void**) {
  count(&FakeCounts::lists, 1);
  return new FakeDevice(*static_cast<const FakeDevice*>(device));
}
int rs2_get_sensors_count(const void*, void**) { return 2; }
void* rs2_create_sensor(const void* list, int index, void**) {
  count(&FakeCounts::sensors, 1);
  auto* sensor = new FakeSensor;
  sensor->device = *static_cast<const FakeDevice*>(list);
  sensor->is_open = false;
  sensor->options[0] = static_cast<float>(index);
  sensor->options[13] = 150;
  sensor->options[46] = 1;
  return sensor;
}
void rs2_delete_sensor_list(void* list) {
  count(&FakeCounts::lists, -1);
  delete static_cast<FakeDevice*>(list);
}
void rs2_delete_sensor(void* sensor) {
  count(&FakeCounts::sensors, -1);
  auto* const self = static_cast<FakeSensor*>(sensor);
  if (self->thread.joinable()) {  // a recording that ended by itself
    self->thread.join();
  }
  delete self;
}
int rs2_is_sensor_extendable_to(const void* sensor, int extension, void**) {
  return extension == 7 && static_cast<const FakeSensor*>(sensor)->options[0] == 1 ? 1 : 0;
}
float rs2_get_depth_scale(void*, void**) {
  const char* const given = std::getenv("FAKE_REALSENSE_UNIT");
  return given != nullptr ? std::strtof(given, nullptr) : static_cast<float>(now().metres_per_unit);
}
int rs2_supports_option(const void*, int option, void** error) {
  if (option > now().last_option) {
    return guarded(error, []() -> int { throw std::runtime_error("invalid enum value"); });
  }
  return option == 12 || option == 13 || option == 18 || option == 46 || option == 53 ? 1 : 0;
}
float rs2_get_option(const void* sensor, int option, void**) {
  return static_cast<const FakeSensor*>(sensor)->options[option];
}
void rs2_set_option(const void* sensor, int option, float value, void** error) {
  guarded(error, [&] {
    count(&FakeCounts::settings, 1);
    if (option == 12 && now().refuses_preset) {
      throw std::runtime_error("hwmon command failed");
    }
    if (option != now().ignored_option) {
      const_cast<FakeSensor*>(static_cast<const FakeSensor*>(sensor))->options[option] = value;
    }
  });
}

// 0: infrared, then depth of two sizes.
void* rs2_get_stream_profiles(void* sensor, void**) { return sensor; }
int rs2_get_stream_profiles_count(const void*, void**) { return 4; }
const void* rs2_get_stream_profile(const void*, int index, void**) {
  static const int numbers[] = {0, 1, 2, 3};
  return &numbers[index];
}
void rs2_delete_stream_profiles_list(void*) {}
void rs2_get_stream_profile_data(const void* profile, int* stream, int* format, int* index, int* id, int* rate,
                                 void**) {
  const int number = *static_cast<const int*>(profile);
  *stream = number == 0 ? 3 : 1;
  *format = number == 0 ? 9 : 1;
  *index = 0;
  *id = number;
  *rate = number == 1 ? 15 : 30;
}
void rs2_get_video_stream_resolution(const void* profile, int* width, int* height, void**) {
  *width = *static_cast<const int*>(profile) == 3 ? 848 : kWidth;
  *height = kHeight;
}
void rs2_get_video_stream_intrinsics(const void* profile, Intrinsics* into, void**) {
  *into = {};
  rs2_get_video_stream_resolution(profile, &into->width, &into->height, nullptr);
  into->ppx = 319.5F;
  into->ppy = 239.5F;
  into->fx = 385;
  into->fy = 386;
  into->model = 4;
  into->coeffs[0] = now().distorts ? 0.1F : 0.0F;
}

void rs2_open(void* sensor, const void*, void**) { static_cast<FakeSensor*>(sensor)->is_open = true; }
void rs2_close(const void* sensor, void**) {
  const_cast<FakeSensor*>(static_cast<const FakeSensor*>(sensor))->is_open = false;
}
void rs2_start(const void* sensor, void (*on_frame)(void*, void*), void* user, void** error) {
  guarded(error, [&] {
    auto* const self = const_cast<FakeSensor*>(static_cast<const FakeSensor*>(sensor));
    if (!now().start_error.empty()) {
      throw std::runtime_error(now().start_error);
    }
    if (!self->is_open) {
      throw std::runtime_error("start called before open");
    }
    self->runs = true;
    *self->device.status = 1;
    self->thread = std::thread([self, on_frame, user] {
      const bool is_recording = !self->device.file.empty();
      for (long number = 0; self->runs && !(is_recording && number >= self->device.frames); ++number) {
        if (is_recording) {
          on_frame(frame_of(number, 1.7e9 + 100 + number / 30.0), user);
          continue;
        }
        const FakeRealSense as = now();
        std::this_thread::sleep_for(std::chrono::duration<double>(kPeriod_s));
        if (!silent_now) {
          FakeFrame* const frame = frame_of(number, system_now_s() - as.arrival_late_s);
          std::this_thread::sleep_for(std::chrono::duration<double>(as.stall_s));
          on_frame(frame, user);
          count(&FakeCounts::sent, 1);
        }
      }
      *self->device.status = 3;
    });
  });
}
void rs2_stop(const void* sensor, void**) {
  auto* const self = const_cast<FakeSensor*>(static_cast<const FakeSensor*>(sensor));
  self->runs = false;
  if (self->thread.joinable()) {
    self->thread.join();
  }
}

void rs2_release_frame(void* frame) {
  count(&FakeCounts::frames, -1);
  delete static_cast<FakeFrame*>(frame);
}
int rs2_get_frame_width(const void* frame, void**) { return static_cast<const FakeFrame*>(frame)->width; }
int rs2_get_frame_height(const void*, void**) { return kHeight; }
int rs2_get_frame_stride_in_bytes(const void* frame, void**) { return 2 * static_cast<const FakeFrame*>(frame)->width; }
int rs2_get_frame_bits_per_pixel(const void*, void**) { return 16; }
const void* rs2_get_frame_data(const void* frame, void** error) {
  return guarded(error, [&]() -> const void* {
    if (static_cast<const FakeFrame*>(frame)->as.frames_have_errors) {
      throw std::runtime_error("frame was\nlost");
    }
    return static_cast<const FakeFrame*>(frame)->pixels.data();
  });
}
unsigned long long rs2_get_frame_number(const void* frame, void**) {
  return static_cast<unsigned long long>(static_cast<const FakeFrame*>(frame)->number);
}
double rs2_get_frame_timestamp(const void* frame, void**) { return static_cast<const FakeFrame*>(frame)->stamp_ms; }
int rs2_get_frame_timestamp_domain(const void* frame, void**) { return static_cast<const FakeFrame*>(frame)->domain; }
int rs2_supports_frame_metadata(const void* frame, int what, void**) {
  return static_cast<const FakeFrame*>(frame)->as.has_metadata && what >= 1 && what <= 3 ? 1 : 0;
}
long long rs2_get_frame_metadata(const void* frame, int what, void**) {
  const auto* const of = static_cast<const FakeFrame*>(frame);
  switch (what) {
    case 1:
      return of->stamp_us;
    case 2:
      return of->stamp_us - static_cast<long>(1e6 * of->as.stamp_late_s);
    default:
      return of->as.exposure_us;
  }
}

unsigned long long rs2_playback_get_duration(const void* device, void**) {
  return static_cast<unsigned long long>(1e9 * static_cast<const FakeDevice*>(device)->frames / 30.0);
}
void rs2_playback_device_set_real_time(const void*, int, void**) {}
int rs2_playback_device_get_current_status(const void* device, void**) {
  return *static_cast<const FakeDevice*>(device)->status;
}

}  // extern "C"

// NOLINTEND
