// A cell that can be worked out by hand: two posts that turn in place, one camera on each side, exact images.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "depthgrid/avoidance/least_padding.hpp"
#include "depthgrid/core/capsule.hpp"

namespace depthgrid::avoidance::test {

/// Pixels without reading around the image of a place.
struct Hole {
  std::size_t camera = 0;
  Eigen::Vector3d at_world = Eigen::Vector3d::Zero();
  int half_px = 4;
};

struct PostOptions {
  std::vector<Pose> T_world_camera;      ///< empty: left and right, on either side of the posts
  std::vector<double> nearer_m{};        ///< of each camera: by how much those posts that err read too near to it
  std::array<bool, 2> errs{true, true};  ///< of post and other
  std::vector<Capsule> things_world{};   ///< what stands there
  std::vector<Hole> holes{};
};

/// Owns the pixels of its cells.
struct PostCell {
  Rig rig;
  robot::RobotModel model;
  std::vector<Capsule> things_world;
  std::vector<DepthImage> images_m;
  std::vector<EmptyCell> cells;
  LeastPaddingSettings settings;
};

/// 'post' stands at y = 0, 'other' at y = 0.8, both 5 cm thick, upright, from 0.2 to 0.6 m.
[[nodiscard]] PostCell post_cell(const std::vector<PostOptions>& cells);
[[nodiscard]] const Capsule& post_world(std::size_t link);  ///< 0: post, 1: other

/// Of the link called so. Throws where there is none.
[[nodiscard]] const LinkPadding& of_link(const LeastPadding& found, const std::string& name);

}  // namespace depthgrid::avoidance::test
