// The demo as a picture: what the cameras measure, what they do not see, and the distances that follow.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/proximity.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/simulation/demo_scene.hpp"

namespace depthgrid::program {

/// What the demo computed, one answer a control point.
struct DemoAnswers {
  std::vector<Proximity> one_camera;
  std::vector<Proximity> two_cameras;
};

/// Writes a PNG: both depth images, and a horizontal slice through the cell at the height of the arm with the space
/// that one camera leaves gray and the space that two leave gray. Frames as in the rig. Throws Error.
void write_demo_picture(const std::filesystem::path& file, const simulation::DemoScene& demo,
                        std::span<const Frame> frames, const DemoAnswers& answers,
                        const grid::DepthQuantisation& quantisation);

}  // namespace depthgrid::program
