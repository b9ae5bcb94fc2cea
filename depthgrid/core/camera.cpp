#include "depthgrid/core/camera.hpp"

#include "depthgrid/core/error.hpp"

namespace depthgrid {

void validate(const PinholeCamera& camera, const char* name) {
  const auto side = [name](const char* what, int value) {
    if (value < 1 || value > kLargestImageSide) {
      fail(name, ": ", what, " is ", value, " px, must be between 1 and ", kLargestImageSide);
    }
  };
  const auto focal = [name](const char* what, double value) {
    if (!(std::isfinite(value) && value > 0)) {
      fail(name, ": ", what, " is ", value, " px, must be a positive finite number");
    }
    if (value > kLargestIntrinsic) {
      fail(name, ": ", what, " is ", value, " px, must be at most ", kLargestIntrinsic);
    }
  };
  const auto finite = [name](const char* what, double value) {
    if (!std::isfinite(value)) {
      fail(name, ": ", what, " is ", value, " px, must be finite");
    }
    if (std::abs(value) > kLargestIntrinsic) {
      fail(name, ": ", what, " is ", value, " px, must be at most ", kLargestIntrinsic, " to either side");
    }
  };
  side("width", camera.width_px);
  side("height", camera.height_px);
  focal("fx", camera.fx_px);
  focal("fy", camera.fy_px);
  finite("cx", camera.cx_px);
  finite("cy", camera.cy_px);
}

PinholeCamera from_opencv(int width_px, int height_px, double fx_px, double fy_px, double cx_px, double cy_px) {
  const PinholeCamera camera{width_px, height_px, fx_px, fy_px, cx_px + 0.5, cy_px + 0.5};
  validate(camera);
  return camera;
}

Eigen::Vector2d principal_point_opencv(const PinholeCamera& camera) noexcept {
  return {camera.cx_px - 0.5, camera.cy_px - 0.5};
}

}  // namespace depthgrid
