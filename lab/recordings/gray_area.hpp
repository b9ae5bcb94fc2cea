// How much of the principal camera's gray area the other cameras free.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "lab/recordings/cameras.hpp"

namespace depthgrid::lab {

/// Volumes in cubic metres, from a sample of the principal camera's depth cells whose centre lies in the workspace.
struct GrayArea {
  double workspace_m3 = 0;             ///< cells of the principal camera in the workspace
  double gray_m3 = 0;                  ///< behind a measurement, or where there is none
  double known_free_letter_m3 = 0;     ///< denied by at least one other camera, by the letter's test
  double known_free_corrected_m3 = 0;  ///< seen free as a whole by one other camera (no margins, filter radius 1 px)
};

/// Every 8th pixel of every 8th row, every 4th cell. `workspace` is a box in the floor frame. `frames` belong to the
/// whole rig. Adds to `area`.
void add_gray_area(const Rig& rig, const CameraSet& cameras, std::span<const Frame> frames,
                   const grid::DepthQuantisation& quantisation, const Eigen::AlignedBox3d& workspace_floor,
                   GrayArea& area);

}  // namespace depthgrid::lab
