#include "depthgrid/sensors/realsense_library.hpp"

#include <mutex>

namespace depthgrid::sensors::rs2 {
namespace {

constexpr const char* kHint =
    "install librealsense2 as its makers describe (their apt repository, or its source), LD_LIBRARY_PATH says where it "
    "is";

Functions functions_of(const SharedLibrary& library) {
  Functions f;
  library.get("rs2_get_api_version", f.get_api_version);
  library.get("rs2_get_error_message", f.get_error_message);
  library.get("rs2_free_error", f.free_error);
  library.get("rs2_log_to_console", f.log_to_console);
  library.get("rs2_create_context", f.create_context);
  library.get("rs2_delete_context", f.delete_context);
  library.get("rs2_query_devices", f.query_devices);
  library.get("rs2_context_add_device", f.context_add_device);
  library.get("rs2_set_devices_changed_callback", f.set_devices_changed_callback);
  library.get("rs2_get_device_count", f.get_device_count);
  library.get("rs2_device_list_contains", f.device_list_contains);
  library.get("rs2_create_device", f.create_device);
  library.get("rs2_delete_device_list", f.delete_device_list);
  library.get("rs2_delete_device", f.delete_device);
  library.get("rs2_supports_device_info", f.supports_device_info);
  library.get("rs2_get_device_info", f.get_device_info);
  library.get("rs2_query_sensors", f.query_sensors);
  library.get("rs2_get_sensors_count", f.get_sensors_count);
  library.get("rs2_create_sensor", f.create_sensor);
  library.get("rs2_delete_sensor_list", f.delete_sensor_list);
  library.get("rs2_delete_sensor", f.delete_sensor);
  library.get("rs2_is_sensor_extendable_to", f.is_sensor_extendable_to);
  library.get("rs2_get_depth_scale", f.get_depth_scale);
  library.get("rs2_supports_option", f.supports_option);
  library.get("rs2_get_option", f.get_option);
  library.get("rs2_set_option", f.set_option);
  library.get("rs2_get_stream_profiles", f.get_stream_profiles);
  library.get("rs2_get_stream_profiles_count", f.get_stream_profiles_count);
  library.get("rs2_get_stream_profile", f.get_stream_profile);
  library.get("rs2_delete_stream_profiles_list", f.delete_stream_profiles_list);
  library.get("rs2_get_stream_profile_data", f.get_stream_profile_data);
  library.get("rs2_get_video_stream_resolution", f.get_video_stream_resolution);
  library.get("rs2_get_video_stream_intrinsics", f.get_video_stream_intrinsics);
  library.get("rs2_open", f.open);
  library.get("rs2_close", f.close);
  library.get("rs2_start", f.start);
  library.get("rs2_stop", f.stop);
  library.get("rs2_release_frame", f.release_frame);
  library.get("rs2_get_frame_width", f.get_frame_width);
  library.get("rs2_get_frame_height", f.get_frame_height);
  library.get("rs2_get_frame_stride_in_bytes", f.get_frame_stride);
  library.get("rs2_get_frame_bits_per_pixel", f.get_frame_bits_per_pixel);
  library.get("rs2_get_frame_data", f.get_frame_data);
  library.get("rs2_get_frame_number", f.get_frame_number);
  library.get("rs2_get_frame_timestamp", f.get_frame_timestamp);
  library.get("rs2_get_frame_timestamp_domain", f.get_frame_timestamp_domain);
  library.get("rs2_supports_frame_metadata", f.supports_frame_metadata);
  library.get("rs2_get_frame_metadata", f.get_frame_metadata);
  library.get("rs2_playback_get_duration", f.playback_get_duration);
  library.get("rs2_playback_device_set_real_time", f.playback_set_real_time);
  library.get("rs2_playback_device_get_current_status", f.playback_get_current_status);
  return f;
}

}  // namespace

std::vector<std::string> Library::usual_names() {
  // Without the developers' package only the file with the number is there.
  constexpr int kNewest = 99;
  constexpr int kOldest = 13;
  std::vector<std::string> names{"librealsense2.so"};
  for (int minor = kNewest; minor >= kOldest; --minor) {
    names.push_back("librealsense2.so.2." + std::to_string(minor));
  }
  return names;
}

Library::Library(const std::vector<std::string>& names) {
  const SharedLibrary library(names, kHint);
  functions_ = functions_of(library);
  name_ = library.name();
  call(functions_.log_to_console, static_cast<int>(kLogNone));
}

std::shared_ptr<const Library> Library::shared() {
  // Where loading fails the next call tries again.
  static std::mutex mutex;
  static std::shared_ptr<const Library> library;
  const std::scoped_lock lock(mutex);
  if (library == nullptr) {
    library = std::make_shared<const Library>(usual_names());
  }
  return library;
}

void Library::throw_error(ErrorObject* error) const {
  constexpr std::size_t kLongest = 200;
  const char* const words = functions_.get_error_message(error);
  const std::string text = printable(words != nullptr ? words : "no reason given").substr(0, kLongest);
  functions_.free_error(error);
  fail("librealsense2: ", text);
}

}  // namespace depthgrid::sensors::rs2
