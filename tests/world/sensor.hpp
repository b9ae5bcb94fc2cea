// What one of the world's cameras reads: rays into the world during an exposure, noise within the margins, holes.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "world/random.hpp"
#include "world/world.hpp"

namespace depthgrid::world {

/// The images of one camera. One thread at a time. The world must outlive it.
class Sensor {
 public:
  Sensor(const World& world, std::size_t camera);

  /// The image lies in this object's memory until the next call.
  [[nodiscard]] DepthView take(const Exposure& exposure);

 private:
  /// A thing in the camera's frame.
  struct Seen {
    Capsule capsule;
    bool black;
  };

  /// What a ray meets first.
  struct Met {
    double depth_m = std::numeric_limits<double>::infinity();
    bool black = false;
  };

  void look(double time_s, int first_row, int last_row);
  void look_at_walls(int first_row, int last_row);
  void look_at(const Seen& seen, int first_row, int last_row);
  void punch_holes(Random& random);
  void read(Random& random);
  [[nodiscard]] float reading_m(const Met& met, double sign, Random& random) const;
  /// What the pixel's ray meets, or the nearest of those around it as well.
  [[nodiscard]] Met met(int u, int v) const;
  void meet(std::size_t ray, double depth_m, bool black) {
    if (depth_m < met_[ray].depth_m) {
      met_[ray] = {depth_m, black};
    }
  }

  const World& world_;
  const TrueCamera& camera_;
  PinholeCamera intrinsics_;
  CameraMargins margins_;
  double metres_per_unit_;
  Pose T_world_camera_ = Pose::Identity();  ///< of the exposure
  Pose T_camera_world_ = Pose::Identity();
  PinholeCamera eye_;  ///< with one ray more on each side than the image has pixels
  std::uint64_t stream_;
  std::vector<Eigen::Vector3d> rays_;
  std::vector<Met> met_;       ///< of each ray
  std::vector<float> metres_;  ///< 0: no reading
  std::vector<std::uint16_t> units_;
};

}  // namespace depthgrid::world
