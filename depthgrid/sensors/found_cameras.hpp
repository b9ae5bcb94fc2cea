// The cameras with drivers that are connected, for a cell file that is begun.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"

namespace depthgrid::sensors {

struct FoundCamera {
  std::string source;  ///< as in a cell file: realsense, freenect, openni
  std::string name;
  std::string serial;                         ///< or URI; empty: it does not say one
  std::optional<PinholeCamera> intrinsics{};  ///< of its depth images
  double metres_per_unit = 0.001;             ///< of them
  bool is_calibrated = false;                 ///< else they are nominal: usual ones of such a device
};

struct FoundCameras {
  std::vector<FoundCamera> cameras;
  std::vector<std::string> notes;  ///< "realsense: ...": why a library was not asked, or a device says nothing
};

/// Asks each maker's library that is installed; sets nothing in the devices. May take seconds.
[[nodiscard]] FoundCameras find_cameras();

}  // namespace depthgrid::sensors
