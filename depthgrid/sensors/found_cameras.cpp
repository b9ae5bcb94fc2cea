#include "depthgrid/sensors/found_cameras.hpp"

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/freenect_camera.hpp"
#include "depthgrid/sensors/openni_stream.hpp"
#include "depthgrid/sensors/realsense_stream.hpp"

namespace depthgrid::sensors {
namespace {

template <class Work>
void noting(FoundCameras& found, const std::string& source, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    found.notes.push_back(source + ": " + error.what());
  }
}

void find_realsense(FoundCameras& found) {
  const auto library = rs2::Library::shared();
  for (const rs2::FoundDevice& device : rs2::connected(*library)) {
    FoundCamera camera{.source = "realsense", .name = device.name, .serial = device.serial, .is_calibrated = true};
    rs2::StreamRequest request;
    request.serial = device.serial;
    request.only_looks = true;
    noting(found, "realsense " + device.serial, [&] {
      const rs2::Stream stream(library, request);
      camera.intrinsics = stream.intrinsics();
      camera.metres_per_unit = stream.metres_per_unit();
    });
    found.cameras.push_back(camera);
  }
}

void find_freenect(FoundCameras& found) {
  for (const std::string& serial : connected_freenect()) {
    found.cameras.push_back({.source = "freenect",
                             .name = "Kinect v1",
                             .serial = serial,
                             .intrinsics = FreenectCamera::nominal(KinectZeroPlane{})});
  }
}

void find_openni(FoundCameras& found) {
  const auto library = OpenniLibrary::shared();
  for (const oni::FoundDevice& device : oni::connected(library)) {
    FoundCamera camera{
        .source = "openni", .name = device.name, .serial = device.serial.empty() ? device.uri : device.serial};
    oni::StreamRequest request;
    request.device = device.uri;
    request.only_looks = true;
    noting(found, "openni " + camera.serial, [&] { camera.intrinsics = oni::DepthStream(library, request).nominal(); });
    found.cameras.push_back(camera);
  }
}

}  // namespace

FoundCameras find_cameras() {
  FoundCameras found;
  noting(found, "realsense", [&] { find_realsense(found); });
  noting(found, "freenect", [&] { find_freenect(found); });
  noting(found, "openni", [&] { find_openni(found); });
  return found;
}

}  // namespace depthgrid::sensors
