// Depth images of a workcell by ray casting (Embree). The ray casting library is not visible from here.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::workcell {

/// Which body of the cell each pixel sees: its index in Workcell::bodies, row-major as the depth image.
struct BodyImage {
  static constexpr std::uint16_t kNone = std::numeric_limits<std::uint16_t>::max();
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint16_t> body;
};

/// Casts one ray through the centre of each pixel of an ideal depth camera, as simulation::Scene::render() does and
/// with the same answer: z of the nearest surface, 0 where there is none, 0 everywhere when the camera is inside a
/// solid (the inside of a mesh is not known). Planes, capsules and spheres are what they are, not tessellated; meshes
/// are instanced, so a link costs its pose only. Coordinates are floats: depths err by micrometres, by more where a ray
/// grazes a round solid (docs/simulation.md).
///
/// One thread; objects are independent of each other.
class DepthCaster {
 public:
  /// Throws Error when the cell is invalid or Embree refuses.
  explicit DepthCaster(const simulation::Workcell& cell);
  ~DepthCaster();
  DepthCaster(const DepthCaster& other) = delete;
  DepthCaster& operator=(const DepthCaster& other) = delete;
  DepthCaster(DepthCaster&& other) noexcept;
  DepthCaster& operator=(DepthCaster&& other) noexcept;

  /// Takes over poses and measures. Throws Error when the bodies differ from those of the constructor
  /// (simulation::validate_same_bodies).
  void update(const simulation::Workcell& cell);

  /// `depth_m` is resized to the camera's image. Throws Error when the camera is invalid.
  void render(const PinholeCamera& camera, const Pose& T_world_camera, DepthImage& depth_m) const;
  void render(const PinholeCamera& camera, const Pose& T_world_camera, DepthImage& depth_m, BodyImage& bodies) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace depthgrid::workcell
