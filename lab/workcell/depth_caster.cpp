#include "lab/workcell/depth_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/workcell/embree_scene.hpp"
#include "lab/workcell/packet_mask.hpp"
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace depthgrid::workcell {

using simulation::Plane;
using simulation::Workcell;
using simulation::WorkcellBody;

namespace {

constexpr int kPacketWidth = 4;  ///< pixels of a packet: a square, so that its rays stay together
constexpr int kPacket = kPacketWidth * kPacketWidth;
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Denormal numbers as zero while it lives, as Embree wants it of its caller's thread.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() noexcept : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero); }
  ~FlushDenormals() { _mm_setcsr(before_); }
#else
  FlushDenormals() = default;
  ~FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals& other) = delete;
  FlushDenormals& operator=(const FlushDenormals& other) = delete;

 private:
#if defined(__SSE__)
  static constexpr unsigned kFlushToZero = 0x8000;
  static constexpr unsigned kDenormalsAreZero = 0x0040;
  unsigned before_;
#endif
};

struct RoomPlane {
  Plane plane_world;
  std::uint16_t body;
};

/// The directions of the rays, scaled so that a ray's parameter is the depth: linear in column and row.
struct Rays {
  Rays(const PinholeCamera& camera, const Pose& T_world_camera)
      : origin(T_world_camera.translation()),
        corner(T_world_camera.linear() * deproject(camera, {0.5, 0.5, 1.0})),
        per_column(T_world_camera.linear().col(0) / camera.fx_px),
        per_row(T_world_camera.linear().col(1) / camera.fy_px) {}

  Eigen::Vector3d origin;
  Eigen::Vector3d corner;  ///< through the centre of pixel (0, 0)
  Eigen::Vector3d per_column;
  Eigen::Vector3d per_row;
};

/// A square of rays through the centres of 4 x 4 pixels, cast together.
class Packet {
 public:
  explicit Packet(const Eigen::Vector3d& origin_world) noexcept {
    const Eigen::Vector3f origin = origin_world.cast<float>();
    std::fill_n(&rays_.ray.org_x[0], kPacket, origin.x());
    std::fill_n(&rays_.ray.org_y[0], kPacket, origin.y());
    std::fill_n(&rays_.ray.org_z[0], kPacket, origin.z());
    std::fill_n(&rays_.ray.tnear[0], kPacket, 0.0F);
    std::fill_n(&rays_.ray.time[0], kPacket, 0.0F);
    std::fill_n(&rays_.ray.mask[0], kPacket, ~0U);
    std::fill_n(&rays_.ray.flags[0], kPacket, 0U);
  }

  /// From pixel (u, v) on; each ray ends where its pixel's depth is already.
  void aim(const Rays& rays, int u, int v, const DepthImage& depth_m) noexcept {
    u_ = u;
    v_ = v;
    const Eigen::Vector3d corner = rays.corner + u * rays.per_column + v * rays.per_row;
    for (int k = 0; k < kPacket; ++k) {
      const int column = k % kPacketWidth;
      const int row = k / kPacketWidth;
      rays_.ray.dir_x[k] = static_cast<float>(corner.x() + column * rays.per_column.x() + row * rays.per_row.x());
      rays_.ray.dir_y[k] = static_cast<float>(corner.y() + column * rays.per_column.y() + row * rays.per_row.y());
      rays_.ray.dir_z[k] = static_cast<float>(corner.z() + column * rays.per_column.z() + row * rays.per_row.z());
      const bool in_image = u + column < depth_m.width_px() && v + row < depth_m.height_px();
      active_[static_cast<std::size_t>(k)] = in_image ? -1 : 0;
      rays_.ray.tfar[k] = in_image ? depth_m.at(u + column, v + row) : 0.0F;
      rays_.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      rays_.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  void cast(RTCScene scene) noexcept {
    RTCIntersectContext context{};
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(active_.data(), scene, &context, &rays_);
  }

  /// Writes what was hit.
  void take(const EmbreeScene& scene, DepthImage& depth_m, BodyImage* bodies) const noexcept {
    for (int k = 0; k < kPacket; ++k) {
      if (active_[static_cast<std::size_t>(k)] == 0 || rays_.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
        continue;
      }
      const std::size_t pixel = depth_m.index(u_ + k % kPacketWidth, v_ + k / kPacketWidth);
      depth_m.data()[pixel] = rays_.ray.tfar[k];
      if (bodies != nullptr) {
        bodies->body[pixel] = scene.body_of_hit(rays_.hit.instID[0][k], rays_.hit.geomID[k], rays_.hit.primID[k]);
      }
    }
  }

 private:
  alignas(64) RTCRayHit16 rays_{};
  alignas(64) std::array<int, kPacket> active_{};
  int u_ = 0;
  int v_ = 0;
};

/// Whether the camera stands in a solid; planes are not asked.
bool inside(const WorkcellBody& body, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = body.T_world_body.inverse(Eigen::Isometry) * p_world;
  const auto any = [&p](const auto& shapes) {
    return std::any_of(shapes.begin(), shapes.end(),
                       [&p](const auto& shape) { return simulation::contains(shape, p); });
  };
  return any(body.planes) || any(body.boxes) || any(body.spheres) || any(body.capsules);
}

}  // namespace

struct DepthCaster::Impl {
  explicit Impl(const Workcell& given)
      : cell((validate(given), given)), scene(cell), boxes_of_meshes(mesh_boxes(cell)) {
    collect_planes();
  }

  void collect_planes() {
    planes.clear();
    for (std::size_t i = 0; i < cell.bodies.size(); ++i) {
      for (const Plane& plane : cell.bodies[i].planes) {
        planes.push_back({transformed(cell.bodies[i].T_world_body, plane), static_cast<std::uint16_t>(i)});
      }
    }
  }

  /// Depth of the nearest plane in every pixel, and its body; exact to the float. Where there is none: kNothing.
  void cast_planes(const Rays& rays, DepthImage& depth_m, BodyImage* bodies) const;
  void cast_rest(const Rays& rays, const PacketMask& mask, DepthImage& depth_m, BodyImage* bodies) const;
  void render(const PinholeCamera& camera, const Pose& T_world_camera, DepthImage& depth_m, BodyImage* bodies) const;

  Workcell cell;
  EmbreeScene scene;
  std::vector<RoomPlane> planes;
  std::vector<simulation::Box> boxes_of_meshes;
};

void DepthCaster::Impl::cast_planes(const Rays& rays, DepthImage& depth_m, BodyImage* bodies) const {
  const int width = depth_m.width_px();
  std::fill_n(depth_m.data(), static_cast<std::size_t>(width) * depth_m.height_px(), kNothing);
  for (const RoomPlane& room : planes) {
    const Eigen::Vector3d& normal = room.plane_world.normal;
    const double above = normal.dot(rays.origin) - room.plane_world.offset_m;  // positive: the camera is outside
    const double per_column = -normal.dot(rays.per_column);
    for (int v = 0; v < depth_m.height_px(); ++v) {
      const double falling = -normal.dot(rays.corner + v * rays.per_row);  // how fast the ray nears the plane
      float* const row = depth_m.data() + depth_m.index(0, v);
      std::uint16_t* const seen = bodies != nullptr ? &bodies->body[depth_m.index(0, v)] : nullptr;
      for (int u = 0; u < width; ++u) {
        const double speed = falling + u * per_column;
        const float z = speed > 0 ? static_cast<float>(above / speed) : kNothing;
        if (seen != nullptr && z < row[u]) {
          seen[u] = room.body;
        }
        row[u] = std::min(row[u], z);
      }
    }
  }
}

void DepthCaster::Impl::cast_rest(const Rays& rays, const PacketMask& mask, DepthImage& depth_m,
                                  BodyImage* bodies) const {
  const FlushDenormals flush;
  Packet packet(rays.origin);
  for (int row = 0; row < mask.rows(); ++row) {
    for (int column = 0; column < mask.columns(); ++column) {
      if (!mask.at(column, row)) {
        continue;
      }
      packet.aim(rays, column * kPacketWidth, row * kPacketWidth, depth_m);
      packet.cast(scene.scene());
      packet.take(scene, depth_m, bodies);
    }
  }
}

void DepthCaster::Impl::render(const PinholeCamera& camera, const Pose& T_world_camera, DepthImage& depth_m,
                               BodyImage* bodies) const {
  depthgrid::validate(camera);
  const std::size_t pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  if (depth_m.width_px() != camera.width_px || depth_m.height_px() != camera.height_px) {
    depth_m = DepthImage(camera.width_px, camera.height_px);
  }
  if (bodies != nullptr) {
    bodies->width_px = camera.width_px;
    bodies->height_px = camera.height_px;
    bodies->body.assign(pixels, BodyImage::kNone);
  }
  if (std::any_of(cell.bodies.begin(), cell.bodies.end(),
                  [&T_world_camera](const WorkcellBody& body) { return inside(body, T_world_camera.translation()); })) {
    std::fill_n(depth_m.data(), pixels, 0.0F);
    return;
  }
  const Rays rays(camera, T_world_camera);
  cast_planes(rays, depth_m, bodies);
  PacketMask mask(camera, kPacketWidth);
  mask.add(cell, boxes_of_meshes, T_world_camera);
  cast_rest(rays, mask, depth_m, bodies);
  std::replace(depth_m.data(), depth_m.data() + pixels, kNothing, 0.0F);
}

DepthCaster::DepthCaster(const Workcell& cell) : impl_(std::make_unique<Impl>(cell)) {}
DepthCaster::~DepthCaster() = default;
DepthCaster::DepthCaster(DepthCaster&& other) noexcept = default;
DepthCaster& DepthCaster::operator=(DepthCaster&& other) noexcept = default;

void DepthCaster::update(const Workcell& cell) {
  validate_same_bodies(impl_->cell, cell);
  impl_->cell = cell;
  impl_->collect_planes();
  impl_->scene.update(cell);
}

void DepthCaster::render(const PinholeCamera& camera, const Pose& T_world_camera, DepthImage& depth_m) const {
  impl_->render(camera, T_world_camera, depth_m, nullptr);
}

void DepthCaster::render(const PinholeCamera& camera, const Pose& T_world_camera, DepthImage& depth_m,
                         BodyImage& bodies) const {
  impl_->render(camera, T_world_camera, depth_m, &bodies);
}

}  // namespace depthgrid::workcell
