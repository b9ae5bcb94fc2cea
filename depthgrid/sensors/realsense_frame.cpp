#include "depthgrid/sensors/realsense_frame.hpp"

#include <cstdint>

namespace depthgrid::sensors::rs2 {
namespace {

constexpr double kMicrosecond_s = 1e-6;
constexpr double kMillisecond_s = 1e-3;

std::optional<std::int64_t> metadata(const Library& library, const Frame* frame, int what) {
  const Functions& f = library.functions();
  if (library.call(f.supports_frame_metadata, frame, what) == 0) {
    return std::nullopt;
  }
  return library.call(f.get_frame_metadata, frame, what);
}

}  // namespace

DepthView depth_of(const Library& library, const Frame* frame, int width_px, int height_px, double metres_per_unit) {
  constexpr int kBits = 16;
  const Functions& f = library.functions();
  const int width = library.call(f.get_frame_width, frame);
  const int height = library.call(f.get_frame_height, frame);
  const int stride = library.call(f.get_frame_stride, frame);
  const int bits = library.call(f.get_frame_bits_per_pixel, frame);
  if (width != width_px || height != height_px || bits != kBits || stride < 2 * width || stride % 2 != 0) {
    fail("sends an image of ", width, " x ", height, " pixels of ", bits, " bits, ", stride,
         " bytes a row, in place of ", width_px, " x ", height_px, " of ", kBits);
  }
  const void* const data = library.call(f.get_frame_data, frame);
  if (data == nullptr) {
    fail("sends an image without pixels");
  }
  return {.data = data,
          .format = DepthFormat::uint16_units,
          .width_px = width,
          .height_px = height,
          .stride_bytes = stride,
          .metres_per_unit = metres_per_unit};
}

std::optional<double> exposure_s(const Library& library, const Frame* frame) {
  const auto exposure_us = metadata(library, frame, kActualExposure);
  if (!exposure_us || *exposure_us <= 0) {
    return std::nullopt;
  }
  return kMicrosecond_s * static_cast<double>(*exposure_us);
}

std::optional<double> middle_before_stamp_s(const Library& library, const Frame* frame) {
  constexpr double kLongest_s = 1;
  const auto read_out_us = metadata(library, frame, kFrameTimestamp);
  const auto middle_us = metadata(library, frame, kSensorTimestamp);
  if (read_out_us && middle_us) {
    const double before_s = kMicrosecond_s * static_cast<double>(*read_out_us - *middle_us);
    if (before_s >= 0 && before_s < kLongest_s) {  // else one of the two counters has wrapped
      return before_s;
    }
  }
  const auto exposed_s = exposure_s(library, frame);
  return exposed_s ? std::optional(*exposed_s / 2) : std::nullopt;
}

double lag_of_stamps(int domain, const ArrivalTimes& declared) {
  if (domain == kSystemTime) {
    return lag_or_refuse(declared,
                         "librealsense2 has no stamps of the device (the kernel lacks the metadata of its images), it "
                         "stamps images when they arrive");
  }
  if (domain == kGlobalTime && !(declared.time_uncertainty_s >= kGlobalTimeError_s)) {
    fail(
        "librealsense2's conversion of the device's clock to this computer's is off by some milliseconds: margins: "
        "{time_uncertainty_s: ",
        kGlobalTimeError_s, "} or more; the cell says ", declared.time_uncertainty_s);
  }
  return 0;
}

double middle_s(const Library& library, const Frame* frame, double lag_s, double period_s) {
  const int domain = library.call(library.functions().get_frame_timestamp_domain, frame);
  const double before_s = domain == kSystemTime ? lag_s : middle_before_stamp_s(library, frame).value_or(period_s);
  return stamp_s(library, frame) - before_s;
}

double stamp_s(const Library& library, const Frame* frame) {
  return kMillisecond_s * library.call(library.functions().get_frame_timestamp, frame);
}

}  // namespace depthgrid::sensors::rs2
