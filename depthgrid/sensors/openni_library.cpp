#include "depthgrid/sensors/openni_library.hpp"

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/sensors/shared_library.hpp"

namespace depthgrid::sensors {

OpenniLibrary::OpenniLibrary(const std::vector<std::string>& names) {
  const SharedLibrary library(names, "install OpenNI2 (Debian: libopenni2-0)");
  oni::Functions& f = functions_;
  library.get("oniInitialize", f.initialize);
  library.get("oniShutdown", f.shutdown);
  library.get("oniGetExtendedError", f.extended_error);
  library.get("oniSetLogConsoleOutput", f.log_to_console);
  library.get("oniSetLogFileOutput", f.log_to_file);
  library.get("oniGetDeviceList", f.get_device_list);
  library.get("oniReleaseDeviceList", f.release_device_list);
  library.get("oniRegisterDeviceCallbacks", f.register_callbacks);
  library.get("oniUnregisterDeviceCallbacks", f.unregister_callbacks);
  library.get("oniDeviceOpen", f.device_open);
  library.get("oniDeviceClose", f.device_close);
  library.get("oniDeviceGetInfo", f.device_info);
  library.get("oniDeviceSetProperty", f.device_set);
  library.get("oniDeviceGetProperty", f.device_get);
  library.get("oniDeviceIsPropertySupported", f.device_has);
  library.get("oniDeviceCreateStream", f.create_stream);
  library.get("oniStreamDestroy", f.stream_destroy);
  library.get("oniStreamGetSensorInfo", f.stream_sensor);
  library.get("oniStreamSetProperty", f.stream_set);
  library.get("oniStreamGetProperty", f.stream_get);
  library.get("oniStreamIsPropertySupported", f.stream_has);
  library.get("oniStreamStart", f.stream_start);
  library.get("oniStreamStop", f.stream_stop);
  library.get("oniWaitForAnyStream", f.wait_for_any);
  library.get("oniStreamReadFrame", f.read_frame);
  library.get("oniFrameRelease", f.frame_release);
}

std::shared_ptr<const OpenniLibrary> OpenniLibrary::shared() {
  static std::mutex mutex;
  // Never destroyed: its drivers' threads may run when the program ends. The lock guards it.
  // NOLINTNEXTLINE(*owning-memory, *avoid-non-const-global-variables): see above
  static auto* const library = new std::shared_ptr<const OpenniLibrary>();
  const std::scoped_lock lock(mutex);
  if (*library == nullptr) {
    *library = std::make_shared<const OpenniLibrary>(std::vector<std::string>{"libOpenNI2.so.0", "libOpenNI2.so"});
  }
  return *library;
}

void OpenniLibrary::check(int status, const char* what) const {
  if (status == oni::kOk) {
    return;
  }
  constexpr std::size_t kLongest = 200;
  const char* const words = functions_.extended_error();
  std::string text = words != nullptr ? words : "";
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) {
    text.pop_back();
  }
  fail("OpenNI2: ", what, ": ",
       text.empty() ? "status " + std::to_string(status) : printable(text).substr(0, kLongest));
}

OpenniLibrary::~OpenniLibrary() {
  if (has_begun_) {
    functions_.shutdown();
  }
}

void OpenniLibrary::begin() const {
  const std::scoped_lock lock(mutex_);
  if (has_begun_) {
    return;
  }
  (void)functions_.log_to_console(0);
  (void)functions_.log_to_file(0);
  check(functions_.initialize(oni::kVersion), "does not begin");
  has_begun_ = true;
  // Its settings file may have switched them on.
  (void)functions_.log_to_console(0);
  (void)functions_.log_to_file(0);
}

std::vector<oni::DeviceInfo> OpenniLibrary::devices() const {
  oni::DeviceInfo* list = nullptr;
  int count = 0;
  check(functions_.get_device_list(&list, &count), "does not list its devices");
  std::vector<oni::DeviceInfo> devices(list, list + count);
  (void)functions_.release_device_list(list);
  return devices;
}

}  // namespace depthgrid::sensors
