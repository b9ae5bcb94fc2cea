#include "depthgrid/sensors/freenect_library.hpp"

#include <mutex>

#include "depthgrid/sensors/shared_library.hpp"

namespace depthgrid::sensors {

FreenectLibrary::FreenectLibrary(const std::vector<std::string>& names) {
  const SharedLibrary library(names, "install libfreenect (Debian: libfreenect0.5)");
  freenect::Functions& f = functions_;
  library.get("freenect_init", f.init);
  library.get("freenect_shutdown", f.shutdown);
  library.get("freenect_set_log_level", f.set_log_level);
  library.get("freenect_set_log_callback", f.set_log_callback);
  library.get("freenect_select_subdevices", f.select_subdevices);
  library.get("freenect_num_devices", f.num_devices);
  library.get("freenect_open_device", f.open_device);
  library.get("freenect_open_device_by_camera_serial", f.open_device_by_camera_serial);
  library.get("freenect_close_device", f.close_device);
  library.get("freenect_find_depth_mode", f.find_depth_mode);
  library.get("freenect_set_depth_mode", f.set_depth_mode);
  library.get("freenect_set_depth_buffer", f.set_depth_buffer);
  library.get("freenect_set_depth_callback", f.set_depth_callback);
  library.get("freenect_start_depth", f.start_depth);
  library.get("freenect_stop_depth", f.stop_depth);
  library.get("freenect_process_events_timeout", f.process_events_timeout);
  library.get_if("freenect_set_flag", f.set_flag);
  library.get_if("freenect_free_device_attributes", f.free_device_attributes);
  if (f.free_device_attributes != nullptr) {
    library.get_if("freenect_list_device_attributes", f.list_device_attributes);
  }
  library.get_if("freenect_destroy_registration", f.destroy_registration);
  if (f.destroy_registration != nullptr) {
    library.get_if("freenect_copy_registration", f.copy_registration);
  }
}

std::shared_ptr<const FreenectLibrary> FreenectLibrary::shared() {
  static std::mutex mutex;
  static std::shared_ptr<const FreenectLibrary> library;
  const std::scoped_lock lock(mutex);
  if (library == nullptr) {
    library = std::make_shared<const FreenectLibrary>(std::vector<std::string>{"libfreenect.so.0.5", "libfreenect.so"});
  }
  return library;
}

}  // namespace depthgrid::sensors
