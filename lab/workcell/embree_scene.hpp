// A workcell as an Embree scene. Included by depth_caster.cpp only.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <vector>

#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::workcell {

/// Owns one reference of an Embree object.
template <class Handle, void (*release)(Handle)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(Handle handle) noexcept : handle_(handle) {}
  ~Owned() { reset(nullptr); }
  Owned(const Owned& other) = delete;
  Owned& operator=(const Owned& other) = delete;
  Owned(Owned&& other) noexcept : handle_(other.handle_) { other.handle_ = nullptr; }
  Owned& operator=(Owned&& other) noexcept {
    if (this != &other) {
      reset(other.handle_);
      other.handle_ = nullptr;
    }
    return *this;
  }
  [[nodiscard]] Handle get() const noexcept { return handle_; }

 private:
  void reset(Handle handle) noexcept {
    if (handle_ != nullptr) {
      release(handle_);
    }
    handle_ = handle;
  }
  Handle handle_ = nullptr;
};

using Device = Owned<RTCDevice, rtcReleaseDevice>;
using RayScene = Owned<RTCScene, rtcReleaseScene>;
using Geometry = Owned<RTCGeometry, rtcReleaseGeometry>;

/// All solids of a cell but its planes, and its meshes: capsules, spheres and boxes of all bodies as one geometry each
/// in the world frame, whose vertices are rewritten; meshes as instances, which are moved.
class EmbreeScene {
 public:
  /// Throws Error when Embree refuses.
  explicit EmbreeScene(const simulation::Workcell& cell);

  /// The bodies are those of the constructor.
  void update(const simulation::Workcell& cell);

  [[nodiscard]] RTCScene scene() const noexcept { return scene_.get(); }

  /// The body that a hit of the scene belongs to.
  [[nodiscard]] std::uint16_t body_of_hit(unsigned instance_id, unsigned geometry_id,
                                          unsigned primitive_id) const noexcept;

 private:
  /// Geometry whose vertices are in the world frame, with the body of each primitive.
  struct Moving {
    Geometry geometry;
    unsigned id = RTC_INVALID_GEOMETRY_ID;
    std::size_t vertices = 0;
    std::vector<std::uint16_t> body_of_primitive;
  };
  struct Instance {
    Geometry geometry;
    RayScene mesh;
    std::size_t body = 0;
  };

  void add_round(Moving& moving, RTCGeometryType type, std::size_t vertices_each);
  void add_boxes();
  void add_instance(const simulation::WorkcellBody& body, std::size_t index);
  RTCGeometry geometry(RTCGeometryType type);
  static void rewrite(const Moving& moving, const std::vector<float>& vertices);
  void check(const char* what) const;

  Device device_;
  RayScene scene_;
  Moving capsules_;
  Moving spheres_;
  Moving boxes_;
  std::vector<Instance> instances_;
  std::vector<std::uint16_t> body_of_instance_;  ///< by the instance's geometry id
};

}  // namespace depthgrid::workcell
