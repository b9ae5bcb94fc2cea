// Which parts of an image anything but the room's planes can show: the rest need not be cast.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::workcell {

/// Boxes around the meshes of a cell, in the frames of their bodies; of no size for a body without.
[[nodiscard]] std::vector<simulation::Box> mesh_boxes(const simulation::Workcell& cell);

/// An image in squares of `side_px` pixels, each set or not.
class PacketMask {
 public:
  PacketMask(const PinholeCamera& camera, int side_px);

  /// Sets every square that a solid or mesh of the cell can appear in.
  void add(const simulation::Workcell& cell, const std::vector<simulation::Box>& mesh_boxes,
           const Pose& T_world_camera);

  [[nodiscard]] bool at(int column, int row) const noexcept {
    return set_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(column)] != 0;
  }
  [[nodiscard]] int columns() const noexcept { return columns_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }

 private:
  template <class Shape>
  void add(const Shape& shape_camera);
  void add_in_pieces(const Capsule& capsule_camera);

  PinholeCamera camera_;
  int side_px_;
  int columns_;
  int rows_;
  std::vector<std::uint8_t> set_;
};

}  // namespace depthgrid::workcell
