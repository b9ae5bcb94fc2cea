#include "depthgrid/sensors/freenect_camera.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/freenect_library.hpp"

namespace depthgrid::sensors {
namespace {

constexpr double kTicks_hz = 60e6;
constexpr double kMetresPerUnit = 0.001;

std::string some_or(const std::vector<std::string>& serials) {
  std::string text;
  for (const std::string& serial : serials) {
    text += (text.empty() ? "" : ", ") + (serial.empty() ? "one that does not say it" : serial);
  }
  return text;
}

struct Images {
  std::uint32_t ticks = 0;   ///< of the newest
  std::int64_t count = 0;    ///< since it was taken
  int images_with_gaps = 0;  ///< of those that come next
  bool has_gaps = false;     ///< the newest one
};

/// libfreenect calls from within its function for events, which next() calls: so the thread knows whose image it is.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): libfreenect's log knows no user, its thread does
thread_local Images* listening = nullptr;

void on_depth(freenect::Device* /*device*/, void* /*pixels*/, std::uint32_t ticks) {
  if (listening != nullptr) {
    listening->ticks = ticks;
    ++listening->count;
    listening->has_gaps = listening->images_with_gaps > 0;
    listening->images_with_gaps -= listening->has_gaps ? 1 : 0;
  }
}

/// libfreenect gives an image of which packets were lost all the same: what they held stays as it was in the image
/// before. Only its log says so, before the image comes; the loss may reach into the next one.
void on_log(freenect::Context* /*context*/, int level, const char* /*words*/) {
  constexpr int kThisAndTheNext = 2;
  if (listening != nullptr && level <= freenect::kInfo) {
    listening->images_with_gaps = kThisAndTheNext;
  }
}

freenect::Context* new_context(const freenect::Functions& f) {
  freenect::Context* context = nullptr;
  const int result = f.init(&context, nullptr);
  if (result < 0 || context == nullptr) {
    fail("libfreenect does not begin (", result, "): is there a USB?");
  }
  f.set_log_callback(context, &on_log);
  f.set_log_level(context, freenect::kInfo);
  f.select_subdevices(context, freenect::kCamera);
  return context;
}

std::vector<std::string> serials_of(const freenect::Functions& f, freenect::Context* context) {
  std::vector<std::string> serials;
  if (f.list_device_attributes == nullptr) {
    serials.resize(static_cast<std::size_t>(std::max(f.num_devices(context), 0)));
    return serials;
  }
  freenect::Attributes* list = nullptr;
  if (f.list_device_attributes(context, &list) > 0) {
    for (const freenect::Attributes* at = list; at != nullptr; at = at->next) {
      serials.push_back(at->camera_serial != nullptr ? printable(at->camera_serial) : "");
    }
  }
  f.free_device_attributes(list);
  return serials;
}

}  // namespace

struct FreenectCamera::Device {
  const freenect::Functions& f;
  freenect::Context* context = nullptr;
  freenect::Device* device = nullptr;
  bool runs = false;
  std::vector<std::uint16_t> raw{};  ///< libfreenect writes here
  Images images;

  explicit Device(const freenect::Functions& functions) : f(functions), context(new_context(functions)) {}
  ~Device() {
    if (runs) {
      (void)f.stop_depth(device);
    }
    if (device != nullptr) {
      (void)f.close_device(device);
    }
    (void)f.shutdown(context);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void open(const std::string& serial);
  void start();
  /// The device's own plane, none: the library does not hand it on.
  [[nodiscard]] std::optional<KinectZeroPlane> plane() const;
};

void FreenectCamera::Device::open(const std::string& serial) {
  const std::vector<std::string> serials = serials_of(f, context);
  if (serials.empty()) {
    fail("no Kinect v1 is connected");
  }
  if (serial.empty() && serials.size() > 1) {
    fail(serials.size(), " Kinects are connected, serial: says which one: ", some_or(serials));
  }
  const bool knows = std::none_of(serials.begin(), serials.end(), [](const auto& one) { return one.empty(); });
  if (!serial.empty() && knows && std::find(serials.begin(), serials.end(), serial) == serials.end()) {
    fail("no Kinect with serial number ", serial, " is connected, there ", serials.size() == 1 ? "is " : "are ",
         some_or(serials));
  }
  const int result = serial.empty() ? f.open_device(context, &device, 0)
                                    : f.open_device_by_camera_serial(context, &device, serial.c_str());
  if (result < 0 || device == nullptr) {
    device = nullptr;
    fail("the Kinect does not open (", result, "): held by another program, or by the kernel's gspca_kinect");
  }
}

void FreenectCamera::Device::start() {
  const freenect::FrameMode mode = f.find_depth_mode(freenect::kMedium, freenect::k11Bit);
  constexpr std::size_t kPixels = std::size_t{kWidth_px} * kHeight_px;
  if (mode.is_valid == 0 || mode.width != kWidth_px || mode.height != kHeight_px ||
      static_cast<std::size_t>(mode.bytes) != 2 * kPixels) {
    fail("the Kinect has no disparities of 11 bits in ", kWidth_px, " x ", kHeight_px, " pixels");
  }
  raw.assign(kPixels, KinectDisparity::kNone);
  f.set_depth_callback(device, &on_depth);
  if (f.set_depth_mode(device, mode) < 0 || f.set_depth_buffer(device, raw.data()) < 0 || f.start_depth(device) < 0) {
    fail("the Kinect does not send depth images");
  }
  runs = true;
}

std::optional<KinectZeroPlane> FreenectCamera::Device::plane() const {
  if (f.copy_registration == nullptr) {
    return std::nullopt;
  }
  freenect::Registration told = f.copy_registration(device);
  const KinectZeroPlane plane{.emitter_distance_cm = told.emitter_distance_cm,
                              .reference_distance_mm = told.reference_distance_mm,
                              .pixel_size_mm = told.reference_pixel_size_mm,
                              .shift = told.const_shift};
  (void)f.destroy_registration(&told);
  const auto near = [](double value, double usual) { return value > usual / 2 && value < usual * 2; };
  const KinectZeroPlane usual;
  if (!near(plane.emitter_distance_cm, usual.emitter_distance_cm) ||
      !near(plane.reference_distance_mm, usual.reference_distance_mm) ||
      !near(plane.pixel_size_mm, usual.pixel_size_mm) || !near(plane.shift, usual.shift)) {
    fail("the Kinect says of itself what cannot be: projector at ", plane.emitter_distance_cm, " cm, reference at ",
         plane.reference_distance_mm, " mm, pixel ", plane.pixel_size_mm, " mm, shift ", plane.shift);
  }
  return plane;
}

PinholeCamera FreenectCamera::nominal(const KinectZeroPlane& plane) {
  const double focal_px = 0.5 * plane.reference_distance_mm / plane.pixel_size_mm;  // of images of twice the size
  return {kWidth_px, kHeight_px, focal_px, focal_px, 0.5 * kWidth_px, 0.5 * kHeight_px};
}

FreenectCamera::FreenectCamera(FreenectSettings settings) : FreenectCamera(std::move(settings), nullptr) {}

FreenectCamera::FreenectCamera(FreenectSettings settings, std::shared_ptr<const FreenectLibrary> library)
    : settings_(std::move(settings)), library_(std::move(library)) {}

FreenectCamera::~FreenectCamera() { close(); }

void FreenectCamera::open() {
  close();
  if (library_ == nullptr) {
    library_ = FreenectLibrary::shared();
  }
  clock_.emplace(
      lag_or_refuse(settings_.arrival, "the Kinect's clock is known here by the arrival of its images alone"));
  auto device = std::make_unique<Device>(library_->functions());
  device->open(settings_.serial);
  const std::optional<KinectZeroPlane> plane = device->plane();
  disparity_ = KinectDisparity(plane.value_or(KinectZeroPlane{}));
  info_ = {.name = "Kinect v1",
           .serial = settings_.serial,
           .clock = "the device, by the images' arrival",
           .intrinsics = std::nullopt,
           .metres_per_unit = kMetresPerUnit,
           .settings = plane ? "distances by the device's own reference"
                             : "distances by a usual reference, not the device's: its library does not hand it on",
           .nominal = nominal(plane.value_or(KinectZeroPlane{}))};
  device->start();
  depth_mm_.assign(device->raw.size(), 0);
  device_ = std::move(device);
  ticks_ = {};
  unsettled_ = 0;
  last_image_s_ = clock_now_s();
  reason_.clear();
}

void FreenectCamera::close() noexcept { device_.reset(); }

Reading FreenectCamera::next(DepthReading& reading, double longest_s) noexcept try {
  if (device_ == nullptr) {
    reason_ = "is not open";
    return Reading::failed;
  }
  const double end_s = clock_now_s() + longest_s;
  listening = &device_->images;
  int result = 0;
  do {
    const double left_s = std::clamp(end_s - clock_now_s(), 0.0, kLongestSilence_s);
    timeval wait{};
    wait.tv_sec = static_cast<time_t>(left_s);
    wait.tv_usec = static_cast<suseconds_t>(1e6 * (left_s - static_cast<double>(wait.tv_sec)));
    result = device_->f.process_events_timeout(device_->context, &wait);
  } while (result >= 0 && device_->images.count == 0 && clock_now_s() < end_s);
  listening = nullptr;
  const double now_s = clock_now_s();
  if (result < 0) {
    fail("was unplugged, or its USB fails (", result, ")");
  }
  const std::int64_t images = std::exchange(device_->images.count, 0);
  if (images == 0) {
    if (now_s - last_image_s_ > kLongestSilence_s) {
      fail("sends no image within ", kLongestSilence_s, " s");
    }
    return Reading::nothing;
  }
  last_image_s_ = now_s;
  const double time_s = clock_->clock_s(static_cast<double>(ticks_.next(device_->images.ticks)) / kTicks_hz, now_s);
  if (!clock_->is_settled() || device_->images.has_gaps) {
    unsettled_ += images;
    return Reading::nothing;
  }
  disparity_.convert(device_->raw, depth_mm_);
  reading.depth = depth_view(depth_mm_, kWidth_px, kHeight_px, kMetresPerUnit);
  reading.time_s = time_s;
  reading.skipped = images - 1 + std::exchange(unsettled_, 0);
  reading.T_world_camera.reset();
  return Reading::got;
} catch (const std::exception& error) {
  listening = nullptr;
  reason_ = error.what();
  return Reading::failed;
}

std::vector<std::string> connected_freenect() {
  const freenect::Functions& f = FreenectLibrary::shared()->functions();
  freenect::Context* const context = new_context(f);
  std::vector<std::string> serials = serials_of(f, context);
  (void)f.shutdown(context);
  return serials;
}

}  // namespace depthgrid::sensors
