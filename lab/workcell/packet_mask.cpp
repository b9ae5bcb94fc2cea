#include "lab/workcell/packet_mask.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/simulation/image_bounds.hpp"

namespace depthgrid::workcell {

using simulation::Box;
using simulation::image_bounds;
using simulation::transformed;
using simulation::Workcell;
using simulation::WorkcellBody;

std::vector<Box> mesh_boxes(const Workcell& cell) {
  std::vector<Box> boxes(cell.bodies.size());
  for (std::size_t i = 0; i < cell.bodies.size(); ++i) {
    if (cell.bodies[i].mesh == nullptr) {
      continue;
    }
    const std::vector<Eigen::Vector3f>& vertices = cell.bodies[i].mesh->vertices_m;
    Eigen::Vector3f low = vertices.front();
    Eigen::Vector3f high = low;
    for (const Eigen::Vector3f& p : vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    boxes[i].T_world_box.translation() = (0.5F * (low + high)).cast<double>();
    boxes[i].half_size_m = (0.5F * (high - low)).cast<double>();
  }
  return boxes;
}

PacketMask::PacketMask(const PinholeCamera& camera, int side_px)
    : camera_(camera),
      side_px_(side_px),
      columns_((camera.width_px + side_px - 1) / side_px),
      rows_((camera.height_px + side_px - 1) / side_px),
      set_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

template <class Shape>
void PacketMask::add(const Shape& shape_camera) {
  const simulation::PixelBounds bounds = image_bounds(camera_, shape_camera);
  if (bounds.u_begin >= bounds.u_end || bounds.v_begin >= bounds.v_end) {
    return;
  }
  const int first = bounds.u_begin / side_px_;
  const int end = (bounds.u_end - 1) / side_px_ + 1;
  for (int row = bounds.v_begin / side_px_; row <= (bounds.v_end - 1) / side_px_; ++row) {
    std::fill_n(set_.begin() + static_cast<std::ptrdiff_t>(row) * columns_ + first, end - first, std::uint8_t{1});
  }
}

/// A capsule across the image fills little of the rectangle around it.
void PacketMask::add_in_pieces(const Capsule& capsule_camera) {
  constexpr int kMaxPieces = 8;
  const Eigen::Vector3d ab = capsule_camera.b - capsule_camera.a;
  const double wanted = std::min<double>(kMaxPieces, std::ceil(ab.norm() / capsule_camera.radius_m));
  const int pieces = std::max(1, static_cast<int>(wanted));
  const Eigen::Vector3d piece = ab / pieces;
  for (int i = 0; i < pieces; ++i) {
    add(Capsule{capsule_camera.a + i * piece, capsule_camera.a + (i + 1) * piece, capsule_camera.radius_m});
  }
}

void PacketMask::add(const Workcell& cell, const std::vector<Box>& mesh_boxes, const Pose& T_world_camera) {
  const Pose T_camera_world = T_world_camera.inverse(Eigen::Isometry);
  for (std::size_t i = 0; i < cell.bodies.size(); ++i) {
    const WorkcellBody& body = cell.bodies[i];
    const Pose T_camera_body = T_camera_world * body.T_world_body;
    for (const Box& box : body.boxes) {
      add(transformed(T_camera_body, box));
    }
    for (const simulation::Sphere& sphere : body.spheres) {
      add(transformed(T_camera_body, sphere));
    }
    for (const Capsule& capsule : body.capsules) {
      add_in_pieces(transformed(T_camera_body, capsule));
    }
    if (body.mesh != nullptr) {
      add(transformed(T_camera_body, mesh_boxes[i]));
    }
  }
}

}  // namespace depthgrid::workcell
