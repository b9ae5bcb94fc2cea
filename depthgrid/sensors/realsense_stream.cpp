#include "depthgrid/sensors/realsense_stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

namespace depthgrid::sensors::rs2 {
namespace {

Owned<Context> new_context(const Library& library) {
  // The version that it says itself: only what all versions have alike is used.
  const int version = library.call(library.functions().get_api_version);
  return {library.call(library.functions().create_context, version), library.functions().delete_context};
}

std::string info_of(const Library& library, const Device* device, int what) {
  const Functions& f = library.functions();
  if (library.call(f.supports_device_info, device, what) == 0) {
    return {};
  }
  const char* const text = library.call(f.get_device_info, device, what);
  return text != nullptr ? printable(text) : "";
}

Owned<DeviceList> devices_of(const Library& library, const Context* context) {
  return {library.call(library.functions().query_devices, context), library.functions().delete_device_list};
}

/// "640 x 480 at 15, 30 Hz; 848 x 480 at 30 Hz"
std::string sizes_text(const std::map<std::pair<int, int>, std::set<int>>& sizes) {
  std::ostringstream text;
  for (const auto& [size, rates] : sizes) {
    text << (text.tellp() > 0 ? "; " : "") << size.first << " x " << size.second << " at ";
    for (const int rate : rates) {
      text << (rate == *rates.begin() ? "" : ", ") << rate;
    }
    text << " Hz";
  }
  return text.str();
}

PinholeCamera pinhole(const Intrinsics& told) {
  const bool bends =
      std::any_of(std::begin(told.coeffs), std::end(told.coeffs), [](float value) { return !(value == 0.0F); });
  if (told.model != kUndistorted && bends) {
    fail("the lens distorts its depth images (model ", told.model, ", coefficients ", told.coeffs[0], ", ",
         told.coeffs[1], ", ...), which is not undone here: take another size of image, or rectified ones");
  }
  return from_opencv(told.width, told.height, told.fx, told.fy, told.ppx, told.ppy);
}

}  // namespace

std::vector<FoundDevice> connected(const Library& library) {
  const Functions& f = library.functions();
  const Owned<Context> context = new_context(library);
  const Owned<DeviceList> list = devices_of(library, context.get());
  std::vector<FoundDevice> found;
  const int count = library.call(f.get_device_count, list.get());
  for (int k = 0; k < count; ++k) {
    try {
      const Owned<Device> device(library.call(f.create_device, list.get(), k), f.delete_device);
      found.push_back({info_of(library, device.get(), kName), info_of(library, device.get(), kSerialNumber)});
    } catch (const Error&) {  // unplugged meanwhile, or held by another program: it is there, but for the others
      found.push_back({"a device that cannot be opened", ""});
    }
  }
  return found;
}

Stream::Stream(std::shared_ptr<const Library> library, const StreamRequest& request)
    : library_(std::move(library)),
      is_recording_(!request.file.empty()),
      context_(new_context(*library_)),
      device_(device_of(request)),
      sensor_(depth_sensor()),
      profiles_(library_->call(f().get_stream_profiles, sensor_.get()), f().delete_stream_profiles_list),
      profile_(profile_of(request)),
      box_(std::make_shared<FrameBox>(library_, is_recording_)) {
  name_ = device_info(kName);
  serial_ = device_info(kSerialNumber);
  if (is_recording_) {
    // Not in real time: the reader waits for who takes the images. Version 2.13 means it the other way round, and
    // without waiting it loses the last ones.
    constexpr int kFirstThatMeansIt = 21400;
    const bool is_reversed = library_->call(f().get_api_version) < kFirstThatMeansIt;
    library_->call(f().playback_set_real_time, static_cast<const Device*>(device_.get()), is_reversed ? 1 : 0);
  } else if (!request.only_looks) {
    library_->call(f().set_devices_changed_callback, static_cast<const Context*>(context_.get()),
                   &Watch::on_devices_changed, watch_.begin(*this));
    set_up();
  }
  int ignored = 0;
  library_->call(f().get_stream_profile_data, profile_, &ignored, &ignored, &ignored, &ignored, &rate_hz_);
  rate_hz_ = std::max(rate_hz_, 1);
  Intrinsics told;
  library_->call(f().get_video_stream_intrinsics, profile_, &told);
  intrinsics_ = pinhole(told);
  metres_per_unit_ = static_cast<double>(library_->call(f().get_depth_scale, sensor_.get()));
  // 0.001F is not 0.001: a unit of whole micrometres is meant as one.
  constexpr double kMicrometres = 1e6;
  const double rounded = std::round(metres_per_unit_ * kMicrometres) / kMicrometres;
  metres_per_unit_ = std::abs(rounded - metres_per_unit_) < 1e-6 * metres_per_unit_ ? rounded : metres_per_unit_;
}

Stream::~Stream() {
  box_->close();  // who waits for room goes on
  ErrorObject* ignored = nullptr;
  const auto forget = [&] {
    if (ignored != nullptr) {
      f().free_error(ignored);
      ignored = nullptr;
    }
  };
  if (is_started_ && is_recording_) {
    // At the end of a file the library's reader stops the sensor itself; version 2.13 locks itself up when both do. So
    // a short file plays to its end, and a longer one is stopped in its middle.
    constexpr auto kLook = std::chrono::milliseconds(5);
    constexpr auto kCalm = std::chrono::milliseconds(50);
    const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    const auto has_stopped = [&] {
      const int status = f().playback_get_current_status(device_.get(), &ignored);
      forget();
      return status == kStopped;
    };
    while (is_started_ && std::chrono::steady_clock::now() < latest) {
      is_started_ = !has_stopped();
      box_.outlives(!is_started_);  // nobody waited for the last frames
      std::this_thread::sleep_for(is_started_ ? kLook : kCalm);
    }
  }
  if (is_started_) {
    f().stop(sensor_.get(), &ignored);
    box_.outlives(ignored != nullptr);
    forget();
  }
  if (is_open_) {
    f().close(sensor_.get(), &ignored);
    forget();
  }
}

Owned<Device> Stream::device_of(const StreamRequest& request) {
  if (is_recording_) {
    return {library_->call(f().context_add_device, context_.get(), request.file.c_str()), f().delete_device};
  }
  const Owned<DeviceList> list = devices_of(*library_, context_.get());
  const int count = library_->call(f().get_device_count, static_cast<const DeviceList*>(list.get()));
  if (count == 0) {
    fail("no RealSense is connected");
  }
  std::string others;
  Owned<Device> device(nullptr, f().delete_device);
  for (int k = 0; k < count; ++k) {
    others += others.empty() ? "" : ", ";
    try {
      Owned<Device> candidate(library_->call(f().create_device, static_cast<const DeviceList*>(list.get()), k),
                              f().delete_device);
      const std::string serial = info_of(*library_, candidate.get(), kSerialNumber);
      others += serial + " (" + info_of(*library_, candidate.get(), kName) + ")";
      if (request.serial.empty() ? count == 1 : serial == request.serial) {
        device = std::move(candidate);
      }
    } catch (const Error& error) {  // another one that another program holds is no reason not to open this one
      others += std::string("one that does not open (") + error.what() + ")";
    }
  }
  if (device == nullptr && request.serial.empty()) {
    fail(count, " RealSense are connected, serial: says which one: ", others);
  }
  if (device == nullptr) {
    fail("no RealSense with serial number ", request.serial, " is connected, there ", count == 1 ? "is " : "are ",
         others);
  }
  return device;
}

std::string Stream::device_info(int what) const { return info_of(*library_, device_.get(), what); }

Owned<Sensor> Stream::depth_sensor() const {
  const Owned<SensorList> list(library_->call(f().query_sensors, static_cast<const Device*>(device_.get())),
                               f().delete_sensor_list);
  const int count = library_->call(f().get_sensors_count, static_cast<const SensorList*>(list.get()));
  for (int k = 0; k < count; ++k) {
    Owned<Sensor> sensor(library_->call(f().create_sensor, static_cast<const SensorList*>(list.get()), k),
                         f().delete_sensor);
    if (library_->call(f().is_sensor_extendable_to, static_cast<const Sensor*>(sensor.get()),
                       static_cast<int>(kDepthSensor)) != 0) {
      return sensor;
    }
  }
  fail("'", device_info(kName), "' has no sensor of depth");
}

const Profile* Stream::profile_of(const StreamRequest& request) const {
  const int count = library_->call(f().get_stream_profiles_count, static_cast<const ProfileList*>(profiles_.get()));
  std::map<std::pair<int, int>, std::set<int>> sizes;
  for (int k = 0; k < count; ++k) {
    const Profile* const profile =
        library_->call(f().get_stream_profile, static_cast<const ProfileList*>(profiles_.get()), k);
    int stream = 0;
    int format = 0;
    int index = 0;
    int id = 0;
    int rate_hz = 0;
    library_->call(f().get_stream_profile_data, profile, &stream, &format, &index, &id, &rate_hz);
    if (stream != kDepth || format != kZ16) {
      continue;
    }
    int width_px = 0;
    int height_px = 0;
    library_->call(f().get_video_stream_resolution, profile, &width_px, &height_px);
    if (request.any_size ||
        (width_px == request.width_px && height_px == request.height_px && rate_hz == request.rate_hz)) {
      return profile;
    }
    sizes[{width_px, height_px}].insert(rate_hz);
  }
  if (sizes.empty()) {
    fail("'", device_info(kName), "' has no stream of 16-bit depth");
  }
  const std::string usb = device_info(kUsbType);
  fail("no depth images of ", request.width_px, " x ", request.height_px, " pixels at ", request.rate_hz,
       " Hz, there are ", sizes_text(sizes), usb.empty() ? "" : "; it is connected by USB " + usb);
}

void Stream::set_up() {
  std::string set;
  std::string refused;
  std::string decides;
  const auto add = [](std::string& list, const std::string& words) { list += (list.empty() ? "" : ", ") + words; };
  // What was asked for and what the device says then; nothing asked: read only. True: it is as asked.
  const auto want = [&](int option, const char* what, std::optional<float> value, bool must) {
    const Sensor* const sensor = sensor_.get();
    try {
      if (library_->call(f().supports_option, sensor, option) == 0) {
        return false;
      }
    } catch (const Error& error) {  // an older library does not know the number
      add(refused, std::string(what) + " (" + error.what() + ")");
      return false;
    }
    try {
      if (value) {
        library_->call(f().set_option, sensor, option, *value);
      }
      const float now = library_->call(f().get_option, sensor, option);
      std::ostringstream text;
      text << what << ' ' << now;
      if (value && !(std::abs(now - *value) < 1e-3F)) {
        text << " in place of " << *value;
        add(must ? decides : refused, text.str());
        return false;
      }
      add(set, text.str());
      return true;
    } catch (const Error& error) {
      add(must ? decides : refused, std::string(what) + " (" + error.what() + ")");
      return false;
    }
  };
  if (name().find("D4") != std::string::npos) {  // the numbers of presets are those of this family
    (void)want(kVisualPreset, "preset", kHighAccuracy, true);
  }
  (void)want(kEmitterEnabled, "emitter", 1.0F, false);
  (void)want(kEmitterOnOff, "emitter on and off", 0.0F, true);
  (void)want(kHdrEnabled, "alternating exposures", 0.0F, true);
  has_global_time_ = want(kGlobalTimeEnabled, "global time", 1.0F, false);
  (void)want(kLaserPower, "laser power", std::nullopt, false);
  if (!decides.empty()) {
    fail("does not take what decides what its readings mean: ", decides,
         ": close what else sets it, or try another firmware");
  }
  settings_ = set + (refused.empty() ? "" : (set.empty() ? "not set: " : "; not set: ") + refused);
}

void Stream::start() {
  library_->call(f().open, sensor_.get(), profile_);
  is_open_ = true;
  library_->call(f().start, static_cast<const Sensor*>(sensor_.get()), &NumberedBox::on_frame, box_.number());
  is_started_ = true;
}

Owned<Frame> Stream::take(double longest_s) { return {box_->take(longest_s), f().release_frame}; }

double Stream::duration_s() const {
  constexpr double kNanosecond_s = 1e-9;
  return kNanosecond_s *
         static_cast<double>(library_->call(f().playback_get_duration, static_cast<const Device*>(device_.get())));
}

bool Stream::has_ended() const {
  return library_->call(f().playback_get_current_status, static_cast<const Device*>(device_.get())) == kStopped;
}

void Stream::look_whether_gone(DeviceList* removed) noexcept {
  ErrorObject* error = nullptr;
  const int is_in = f().device_list_contains(removed, device_.get(), &error);
  if (error != nullptr) {
    f().free_error(error);
  } else if (is_in != 0) {
    is_gone_.store(true, std::memory_order_relaxed);
  }
}

namespace {

std::mutex& watch_mutex() {
  static std::mutex mutex;
  return mutex;
}

std::map<std::uintptr_t, Stream*>& watchers() {
  static std::map<std::uintptr_t, Stream*> streams;
  return streams;
}

}  // namespace

void* Watch::begin(Stream& stream) {
  static std::uintptr_t last = 0;
  const std::scoped_lock lock(watch_mutex());
  number_ = ++last;
  watchers().emplace(number_, &stream);
  return reinterpret_cast<void*>(number_);  // NOLINT(*reinterpret-cast,*int-to-ptr): a number, no pointer
}

Watch::~Watch() {
  const std::scoped_lock lock(watch_mutex());
  watchers().erase(number_);
}

void Watch::on_devices_changed(DeviceList* removed, DeviceList* added, void* number) noexcept {
  const std::scoped_lock lock(watch_mutex());
  const auto at = watchers().find(reinterpret_cast<std::uintptr_t>(number));  // NOLINT(*reinterpret-cast)
  if (at == watchers().end()) {
    return;  // its lists stay: who asked has gone, and with it the way to the library
  }
  at->second->look_whether_gone(removed);
  at->second->f().delete_device_list(removed);
  at->second->f().delete_device_list(added);
}

}  // namespace depthgrid::sensors::rs2
