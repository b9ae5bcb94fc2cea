#include "depthgrid/workcell/depth_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "depthgrid/workcell/embree_scene.hpp"
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
  explicit Impl(const Workcell& given) : cell((validate(given), given)), scene(cell) { collect_planes(); }

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
  void cast_rest(const Rays& rays, DepthImage& depth_m, BodyImage* bodies) const;
  void render(const PinholeCamera& camera, const Pose& T_world_camera, DepthImage& depth_m, BodyImage* bodies) const;

  Workcell cell;
  EmbreeScene scene;
  std::vector<RoomPlane> planes;
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
      if (bodies == nullptr) {
        for (int u = 0; u < width; ++u) {
          const double speed = falling + u * per_column;
          const float z = speed > 0 ? static_cast<float>(above / speed) : kNothing;
          row[u] = std::min(row[u], z);
        }
      } else {
        for (int u = 0; u < width; ++u) {
          const double speed = falling + u * per_column;
          const float z = speed > 0 ? static_cast<float>(above / speed) : kNothing;
          if (z < row[u]) {
            row[u] = z;
            bodies->body[depth_m.index(u, v)] = room.body;
          }
        }
      }
    }
  }
}

void DepthCaster::Impl::cast_rest(const Rays& rays, DepthImage& depth_m, BodyImage* bodies) const {
  const FlushDenormals flush;
  const Eigen::Vector3f origin = rays.origin.cast<float>();
  alignas(64) RTCRayHit16 packet;
  alignas(64) std::array<int, kPacket> valid{};
  for (int v0 = 0; v0 < depth_m.height_px(); v0 += kPacketWidth) {
    for (int u0 = 0; u0 < depth_m.width_px(); u0 += kPacketWidth) {
      for (int k = 0; k < kPacket; ++k) {
        const int u = u0 + k % kPacketWidth;
        const int v = v0 + k / kPacketWidth;
        valid[static_cast<std::size_t>(k)] = u < depth_m.width_px() && v < depth_m.height_px() ? -1 : 0;
        const Eigen::Vector3f direction = (rays.corner + u * rays.per_column + v * rays.per_row).cast<float>();
        packet.ray.org_x[k] = origin.x();
        packet.ray.org_y[k] = origin.y();
        packet.ray.org_z[k] = origin.z();
        packet.ray.dir_x[k] = direction.x();
        packet.ray.dir_y[k] = direction.y();
        packet.ray.dir_z[k] = direction.z();
        packet.ray.tnear[k] = 0;
        packet.ray.tfar[k] = valid[static_cast<std::size_t>(k)] != 0 ? depth_m.at(u, v) : 0;
        packet.ray.time[k] = 0;
        packet.ray.mask[k] = ~0U;
        packet.ray.flags[k] = 0;
        packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      }
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
      rtcIntersect16(valid.data(), scene.scene(), &context, &packet);
      for (int k = 0; k < kPacket; ++k) {
        if (valid[static_cast<std::size_t>(k)] == 0 || packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
          continue;
        }
        const std::size_t pixel = depth_m.index(u0 + k % kPacketWidth, v0 + k / kPacketWidth);
        depth_m.data()[pixel] = packet.ray.tfar[k];
        if (bodies != nullptr) {
          bodies->body[pixel] = scene.body_of_hit(packet.hit.instID[0][k], packet.hit.geomID[k], packet.hit.primID[k]);
        }
      }
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
  cast_rest(rays, depth_m, bodies);
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
