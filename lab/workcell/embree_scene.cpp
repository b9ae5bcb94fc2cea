#include "lab/workcell/embree_scene.hpp"

#include <algorithm>
#include <array>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/triangle_mesh.hpp"

namespace depthgrid::workcell {

using simulation::Workcell;
using simulation::WorkcellBody;

namespace {

constexpr std::size_t kBoxVertices = 8;
constexpr std::size_t kBoxTriangles = 12;
constexpr std::size_t kFloatsOfRound = 4;  ///< x, y, z, radius

void append(std::vector<float>& to, const Eigen::Vector3d& point) {
  for (const double coordinate : point) {
    to.push_back(static_cast<float>(coordinate));
  }
}

void append(std::vector<float>& to, const Eigen::Vector3d& point, double radius_m) {
  append(to, point);
  to.push_back(static_cast<float>(radius_m));
}

}  // namespace

EmbreeScene::EmbreeScene(const Workcell& cell) : device_(rtcNewDevice("threads=1,set_affinity=0")) {
  if (device_.get() == nullptr) {
    fail("Embree gives no device, error ", rtcGetDeviceError(nullptr));
  }
  scene_ = RayScene(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
  for (std::size_t i = 0; i < cell.bodies.size(); ++i) {
    const WorkcellBody& body = cell.bodies[i];
    const auto index = static_cast<std::uint16_t>(i);
    capsules_.body_of_primitive.insert(capsules_.body_of_primitive.end(), body.capsules.size(), index);
    spheres_.body_of_primitive.insert(spheres_.body_of_primitive.end(), body.spheres.size(), index);
    boxes_.body_of_primitive.insert(boxes_.body_of_primitive.end(), body.boxes.size() * kBoxTriangles, index);
    if (body.mesh != nullptr) {
      add_instance(body, i);
    }
  }
  add_round(capsules_, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE, 2);
  add_round(spheres_, RTC_GEOMETRY_TYPE_SPHERE_POINT, 1);
  add_boxes();
  update(cell);
}

void EmbreeScene::check(const char* what) const {
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error != RTC_ERROR_NONE) {
    fail("Embree refuses ", what, ", error ", error);
  }
}

RTCGeometry EmbreeScene::geometry(RTCGeometryType type) {
  auto* const result = rtcNewGeometry(device_.get(), type);
  if (result == nullptr) {
    fail("Embree gives no geometry of type ", type, ", error ", rtcGetDeviceError(device_.get()));
  }
  return result;
}

void EmbreeScene::add_round(Moving& moving, RTCGeometryType type, std::size_t vertices_each) {
  const std::size_t primitives = moving.body_of_primitive.size();
  if (primitives == 0) {
    return;
  }
  moving.vertices = primitives * vertices_each;
  moving.geometry = Geometry(geometry(type));
  RTCGeometry shape = moving.geometry.get();
  rtcSetNewGeometryBuffer(shape, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, kFloatsOfRound * sizeof(float),
                          moving.vertices);
  if (vertices_each == 2) {
    auto* const first = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(shape, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(std::uint32_t), primitives));
    for (std::size_t i = 0; i < primitives; ++i) {
      first[i] = static_cast<std::uint32_t>(2 * i);
    }
  }
  moving.id = rtcAttachGeometry(scene_.get(), shape);
  check("round solids");
}

void EmbreeScene::add_boxes() {
  const std::size_t boxes = boxes_.body_of_primitive.size() / kBoxTriangles;
  if (boxes == 0) {
    return;
  }
  boxes_.vertices = boxes * kBoxVertices;
  boxes_.geometry = Geometry(geometry(RTC_GEOMETRY_TYPE_TRIANGLE));
  RTCGeometry shape = boxes_.geometry.get();
  rtcSetNewGeometryBuffer(shape, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), boxes_.vertices);
  auto* corner = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(shape, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                     3 * sizeof(std::uint32_t), boxes * kBoxTriangles));
  const simulation::TriangleMesh unit = mesh_of(simulation::Box{});
  for (std::size_t i = 0; i < boxes; ++i) {
    for (const Eigen::Vector3i& triangle : unit.triangles) {
      for (const int index : triangle) {
        *corner++ = static_cast<std::uint32_t>(i * kBoxVertices + static_cast<std::size_t>(index));
      }
    }
  }
  boxes_.id = rtcAttachGeometry(scene_.get(), shape);
  check("boxes");
}

void EmbreeScene::add_instance(const WorkcellBody& body, std::size_t index) {
  const simulation::TriangleMesh& mesh = *body.mesh;
  const Geometry triangles(geometry(RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
      triangles.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices_m.size()));
  for (const Eigen::Vector3f& p : mesh.vertices_m) {
    vertex = std::copy_n(p.data(), 3, vertex);
  }
  auto* corner = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      triangles.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    corner = std::copy_n(triangle.data(), 3, corner);
  }
  rtcCommitGeometry(triangles.get());
  Instance instance;
  instance.body = index;
  instance.mesh = RayScene(rtcNewScene(device_.get()));
  rtcSetSceneFlags(instance.mesh.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(instance.mesh.get(), RTC_BUILD_QUALITY_HIGH);
  rtcAttachGeometry(instance.mesh.get(), triangles.get());
  rtcCommitScene(instance.mesh.get());
  instance.geometry = Geometry(geometry(RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(instance.geometry.get(), instance.mesh.get());
  const unsigned id = rtcAttachGeometry(scene_.get(), instance.geometry.get());
  body_of_instance_.resize(std::max<std::size_t>(body_of_instance_.size(), id + 1));
  body_of_instance_[id] = static_cast<std::uint16_t>(index);
  instances_.push_back(std::move(instance));
  check("a mesh");
}

void EmbreeScene::rewrite(const Moving& moving, const std::vector<float>& vertices) {
  if (moving.vertices > 0) {
    RTCGeometry shape = moving.geometry.get();
    std::copy(vertices.begin(), vertices.end(),
              static_cast<float*>(rtcGetGeometryBufferData(shape, RTC_BUFFER_TYPE_VERTEX, 0)));
    rtcUpdateGeometryBuffer(shape, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(shape);
  }
}

void EmbreeScene::update(const Workcell& cell) {
  std::vector<float> capsules;
  std::vector<float> spheres;
  std::vector<float> boxes;
  for (const WorkcellBody& body : cell.bodies) {
    const Pose& T = body.T_world_body;
    for (const Capsule& c : body.capsules) {
      append(capsules, T * c.a, c.radius_m);
      append(capsules, T * c.b, c.radius_m);
    }
    for (const simulation::Sphere& s : body.spheres) {
      append(spheres, T * s.centre_world, s.radius_m);
    }
    for (const simulation::Box& b : body.boxes) {
      for (const Eigen::Vector3f& p : mesh_of(transformed(T, b)).vertices_m) {
        boxes.insert(boxes.end(), p.begin(), p.end());
      }
    }
  }
  rewrite(capsules_, capsules);
  rewrite(spheres_, spheres);
  rewrite(boxes_, boxes);
  for (const Instance& instance : instances_) {
    const Eigen::Matrix<float, 3, 4> transform =
        cell.bodies[instance.body].T_world_body.matrix().topRows<3>().cast<float>();
    rtcSetGeometryTransform(instance.geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
    rtcCommitGeometry(instance.geometry.get());
  }
  rtcCommitScene(scene_.get());
  check("the cell");
}

std::uint16_t EmbreeScene::body_of_hit(unsigned instance_id, unsigned geometry_id,
                                       unsigned primitive_id) const noexcept {
  if (instance_id != RTC_INVALID_GEOMETRY_ID) {
    return body_of_instance_[instance_id];
  }
  const Moving& moving = geometry_id == capsules_.id ? capsules_ : geometry_id == spheres_.id ? spheres_ : boxes_;
  return moving.body_of_primitive[primitive_id];
}

}  // namespace depthgrid::workcell
