#include "depthgrid/sensors/openni_stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <sstream>
#include <thread>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::sensors::oni {
namespace {

std::string words_of(const std::array<char, kLongestText>& text) {
  return printable(std::string(text.data(), ::strnlen(text.data(), text.size())));
}

std::string listed(const std::vector<FoundDevice>& devices) {
  std::string text;
  for (const FoundDevice& device : devices) {
    text +=
        (text.empty() ? "" : ", ") + (device.serial.empty() ? device.uri : device.serial) + " (" + device.name + ")";
  }
  return text;
}

std::string serial_of_device(const Functions& f, Device device) {
  std::array<char, kLongestText> text{};
  int size = static_cast<int>(text.size());
  if (f.device_has(device, kSerialNumber) == 0 || f.device_get(device, kSerialNumber, text.data(), &size) != kOk) {
    return {};
  }
  return words_of(text);
}

std::string name_of(const DeviceInfo& info) {
  const std::string vendor = words_of(info.vendor);
  return vendor + (vendor.empty() ? "" : " ") + words_of(info.name);
}

std::vector<FoundDevice> found_by(const OpenniLibrary& library) {
  library.begin();
  const Functions& f = library.functions();
  std::vector<FoundDevice> found;
  for (const DeviceInfo& info : library.devices()) {
    const std::string uri(info.uri.data(), ::strnlen(info.uri.data(), info.uri.size()));
    Device device = nullptr;
    std::string serial;
    if (f.device_open(uri.c_str(), &device) == kOk) {
      serial = serial_of_device(f, device);
      (void)f.device_close(device);
    }
    found.push_back({name_of(info), uri, serial});
  }
  return found;
}

std::string modes_text(const SensorInfo* sensor) {
  std::ostringstream text;
  for (int k = 0; sensor != nullptr && k < sensor->count; ++k) {
    const VideoMode& mode = sensor->modes[k];
    if (mode.format == kDepth1mm || mode.format == kDepth100um) {
      text << (text.tellp() > 0 ? "; " : "") << mode.width << " x " << mode.height << " at " << mode.rate_hz << " Hz";
    }
  }
  return text.str();
}

}  // namespace

std::vector<FoundDevice> connected(const std::shared_ptr<const OpenniLibrary>& library) { return found_by(*library); }

DepthStream::DepthStream(std::shared_ptr<const OpenniLibrary> library, const StreamRequest& request)
    : library_(std::move(library)), is_recording_(!request.file.empty()) {
  library_->begin();
  // The destructor does not run where this throws.
  const auto undo = [](DepthStream* self) { self->close(); };
  std::unique_ptr<DepthStream, decltype(undo)> guard(this, undo);
  uri_ = is_recording_ ? request.file : uri_of(request);
  library_->check(f().device_open(uri_.c_str(), &device_), "does not open");
  DeviceInfo info;
  library_->check(f().device_info(device_, &info), "says nothing of the device");
  name_ = name_of(info);
  serial_ = serial_of_device(f(), device_);
  serial_ = serial_.empty() ? uri_ : serial_;
  library_->check(f().create_stream(device_, kDepth, &stream_), "has no depth");
  if (request.only_looks) {
    mode_ = {kDepth1mm, request.width_px, request.height_px, request.rate_hz};
  } else {
    set_up(request);
    read_mode(request);
  }
  (void)guard.release();
}

DepthStream::~DepthStream() { close(); }

void DepthStream::stop() noexcept {
  if (!is_started_) {
    return;
  }
  f().stream_stop(stream_);
  is_started_ = false;
  if (is_recording_) {
    // Its player goes round its streams without a lock, at a file's end as fast as it can. Where none runs it sleeps
    // for 10 ms each time: only then a stream is taken from under it without harm.
    constexpr auto kAsleep = std::chrono::milliseconds(30);
    std::this_thread::sleep_for(kAsleep);
  }
}

void DepthStream::close() noexcept {
  stop();
  if (stream_ != nullptr) {
    f().stream_destroy(stream_);
  }
  if (callbacks_ != nullptr) {
    f().unregister_callbacks(callbacks_);
  }
  if (device_ != nullptr) {
    (void)f().device_close(device_);
  }
}

std::string DepthStream::uri_of(const StreamRequest& request) const {
  const std::vector<FoundDevice> found = found_by(*library_);
  if (found.empty()) {
    fail("no device of OpenNI2 is connected");
  }
  if (request.device.empty() && found.size() > 1) {
    fail(found.size(), " devices of OpenNI2 are connected, serial: says which one: ", listed(found));
  }
  for (const FoundDevice& device : found) {
    if (request.device.empty() || request.device == device.uri || request.device == device.serial) {
      return device.uri;
    }
  }
  fail("no device of OpenNI2 with serial number or URI ", request.device, " is connected, there ",
       found.size() == 1 ? "is " : "are ", listed(found));
}

void DepthStream::set_up(const StreamRequest& request) {
  std::string told;
  const auto tell = [&](const std::string& words) { told += (told.empty() ? "" : ", ") + words; };
  int registered = 0;
  int size = sizeof registered;
  if (f().device_has(device_, kImageRegistration) != 0) {
    const int off = 0;
    if (!is_recording_) {
      (void)f().device_set(device_, kImageRegistration, &off, sizeof off);
    }
    if (f().device_get(device_, kImageRegistration, &registered, &size) != kOk) {
      fail("does not say whether its depth images are resampled into the colour camera's view");
    }
    if (registered != 0) {
      fail("its depth images are resampled into the colour camera's view: switch registration off");
    }
    tell("registration off");
  }
  if (is_recording_) {
    const float as_asked = -1;  // an image when it is asked for
    const int no = 0;
    library_->check(f().device_set(device_, kPlaybackSpeed, &as_asked, sizeof as_asked), "does not wait to be asked");
    library_->check(f().device_set(device_, kPlaybackRepeat, &no, sizeof no), "does not end");
  } else {
    const int no = 0;
    (void)f().stream_set(stream_, kMirroring, &no, sizeof no);
    DeviceCallbacks callbacks;
    callbacks.disconnected = &on_disconnected;
    library_->check(f().register_callbacks(&callbacks, this, &callbacks_), "does not say what is unplugged");
    const VideoMode wanted{kDepth1mm, request.width_px, request.height_px, request.rate_hz};
    if (f().stream_set(stream_, kVideoMode, &wanted, sizeof wanted) != kOk) {
      fail("no depth images of ", request.width_px, " x ", request.height_px, " pixels at ", request.rate_hz,
           " Hz in millimetres, there are ", modes_text(f().stream_sensor(stream_)));
    }
    tell(filters_off());
  }
  int mirrored = request.mirrored ? 1 : 0;
  size = sizeof mirrored;
  if (is_recording_ ||
      (f().stream_has(stream_, kMirroring) != 0 && f().stream_get(stream_, kMirroring, &mirrored, &size) == kOk)) {
    is_mirrored_ = mirrored != 0;
    tell(is_mirrored_ ? "mirrored images are turned back here" : "not mirrored");
  } else {
    fail("does not say whether its images are mirrored");
  }
  settings_ = told;
}

// A hole that is filled is a reading that nobody took, and frees the space before it.
std::string DepthStream::filters_off() {
  std::string told;
  const auto off = [&](int property, const char* name) {
    const std::uint64_t wide = 0;  // PrimeSense's size of a number; others take the half of it
    const std::uint32_t narrow = 0;
    if (f().stream_set(stream_, property, &wide, sizeof wide) != kOk) {
      (void)f().stream_set(stream_, property, &narrow, sizeof narrow);
    }
    std::uint64_t now = 0;
    std::uint32_t narrow_now = 0;
    int size = sizeof now;
    if (f().stream_get(stream_, property, &now, &size) != kOk) {
      size = sizeof narrow_now;
      if (f().stream_get(stream_, property, &narrow_now, &size) != kOk) {
        return false;
      }
      now = narrow_now;
    }
    if (now != 0) {
      fail("its ", name, " stays on (", now, "): it invents distances where the camera has none");
    }
    told += (told.empty() ? "" : ", ") + std::string(name) + " off";
    return true;
  };
  if (!off(kHoleFilter, "hole filter")) {
    told = "its driver says nothing of a hole filter";
  }
  (void)off(kSoftwareFilter, "software filter");
  return told;
}

void DepthStream::read_mode(const StreamRequest& request) {
  int size = sizeof mode_;
  library_->check(f().stream_get(stream_, kVideoMode, &mode_, &size), "says no size of its images");
  if (mode_.format != kDepth1mm && mode_.format != kDepth100um) {
    fail("its images are of format ", mode_.format, ", neither millimetres (100) nor tenths of them (101)");
  }
  if (mode_.width < 1 || mode_.height < 1 || mode_.width > kLargestImageSide || mode_.height > kLargestImageSide) {
    fail("says images of ", mode_.width, " x ", mode_.height, " pixels");
  }
  if (!is_recording_ && (mode_.width != request.width_px || mode_.height != request.height_px)) {
    fail("has taken ", mode_.width, " x ", mode_.height, " pixels in place of ", request.width_px, " x ",
         request.height_px);
  }
  pixels_.assign(static_cast<std::size_t>(mode_.width) * static_cast<std::size_t>(mode_.height), 0);
}

std::optional<PinholeCamera> DepthStream::nominal() const {
  float horizontal = 0;
  float vertical = 0;
  int size = sizeof horizontal;
  if (f().stream_get(stream_, kHorizontalFov, &horizontal, &size) != kOk) {
    return std::nullopt;
  }
  size = sizeof vertical;
  if (f().stream_get(stream_, kVerticalFov, &vertical, &size) != kOk) {
    return std::nullopt;
  }
  const auto focal = [](double side_px, double angle) { return 0.5 * side_px / std::tan(0.5 * angle); };
  const PinholeCamera camera{mode_.width,
                             mode_.height,
                             focal(mode_.width, static_cast<double>(horizontal)),
                             focal(mode_.height, static_cast<double>(vertical)),
                             0.5 * mode_.width,
                             0.5 * mode_.height};
  try {
    validate(camera);
  } catch (const Error&) {
    return std::nullopt;
  }
  return camera;
}

int DepthStream::frames() const {
  int frames = 0;
  int size = sizeof frames;
  return f().stream_get(stream_, kNumberOfFrames, &frames, &size) == kOk ? frames : 0;
}

void DepthStream::start() {
  library_->check(f().stream_start(stream_), "does not start");
  is_started_ = true;
}

bool DepthStream::take(double longest_s) {
  constexpr double kMilliseconds = 1e3;
  Stream stream = stream_;
  int which = 0;
  const int status = f().wait_for_any(&stream, 1, &which,
                                      static_cast<int>(std::ceil(kMilliseconds * std::clamp(longest_s, 0.0, 10.0))));
  if (status == kTimeOut) {
    return false;
  }
  library_->check(status, "does not send");
  Frame* frame = nullptr;
  library_->check(f().read_frame(stream_, &frame), "sends nothing that can be read");
  try {
    copy(*frame);
  } catch (...) {
    f().frame_release(frame);
    throw;
  }
  f().frame_release(frame);
  return true;
}

void DepthStream::copy(const Frame& frame) {
  const std::size_t row_bytes = 2 * static_cast<std::size_t>(mode_.width);
  if (frame.width != mode_.width || frame.height != mode_.height || frame.is_cropped != 0 ||
      frame.mode.format != mode_.format || frame.data == nullptr || frame.stride < static_cast<int>(row_bytes) ||
      frame.size < frame.stride * (frame.height - 1) + static_cast<int>(row_bytes)) {
    fail("sends an image of ", frame.width, " x ", frame.height, " pixels, format ", frame.mode.format,
         frame.is_cropped != 0 ? ", cropped" : "", ", in place of ", mode_.width, " x ", mode_.height);
  }
  for (int y = 0; y < frame.height; ++y) {
    const char* const row = static_cast<const char*>(frame.data) + static_cast<std::ptrdiff_t>(y) * frame.stride;
    const auto to = pixels_.begin() + static_cast<std::ptrdiff_t>(y) * mode_.width;
    std::memcpy(&*to, row, row_bytes);
    if (is_mirrored_) {
      std::reverse(to, to + mode_.width);
    }
  }
  constexpr double kMicrosecond_s = 1e-6;
  stamp_s_ = kMicrosecond_s * static_cast<double>(frame.timestamp_us);
  index_ = frame.index;
}

DepthView DepthStream::depth() const { return depth_view(pixels_, mode_.width, mode_.height, metres_per_unit()); }

void DepthStream::on_disconnected(const DeviceInfo* info, void* stream) noexcept {
  auto& self = *static_cast<DepthStream*>(stream);
  if (info != nullptr && self.uri_ == std::string_view(info->uri.data(), ::strnlen(info->uri.data(), kLongestText))) {
    self.is_gone_.store(true, std::memory_order_relaxed);
  }
}

}  // namespace depthgrid::sensors::oni
