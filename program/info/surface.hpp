// A depth image as surface points with normals, for comparing cameras.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"

namespace depthgrid::program {

/// Camera frame, metres; index v * width_px + u. A point without measurement has z = 0, one without normal a zero
/// normal. Points belong to the pixels' centres, normals point to the camera.
struct Surface {
  int width_px = 0;
  int height_px = 0;
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
};

/// Normals come from the neighbours three pixels away in rows and columns, all measured and no more than 0.2 m from the
/// pixel in depth. Writes into `surface`, whose memory is used again.
void make_surface(const PinholeCamera& camera, const DepthImage& depth, Surface& surface);

}  // namespace depthgrid::program
