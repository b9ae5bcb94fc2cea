#include "depthgrid/search/exact_tests.hpp"

#include "depthgrid/views/ball_query.hpp"
#include "depthgrid/views/blocking_point.hpp"

namespace depthgrid::search {

using views::projects_inside;

Box box_of(const CubeQuery& query, const Cube& cube) noexcept {
  const Eigen::Vector3d centre(static_cast<double>(cube.x), static_cast<double>(cube.y), static_cast<double>(cube.z));
  const auto half_m = Eigen::Vector3d::Constant(static_cast<double>(query.lattice.half_side_m(cube.level)));
  Box box{centre - half_m, centre + half_m};
  if (query.boxed) {
    box.low = box.low.cwiseMax(query.space_low).cwiseMin(query.space_high);
    box.high = box.high.cwiseMin(query.space_high).cwiseMax(query.space_low);
  }
  return box;
}

bool in_space(const CubeQuery& query, const Eigen::Vector3d& x_local) noexcept {
  if (query.principal < 0) {
    return true;  // boxes are cut to W
  }
  const LocalCamera& camera = query.cameras[static_cast<std::size_t>(query.principal)];
  const Eigen::Vector3d x = camera.to_camera(x_local);
  return x.z() > 0 && x.z() >= query.frustum.d_min_m && x.z() <= query.frustum.d_max_m &&
         projects_inside(camera.pinhole, x);
}

bool may_be_occupied(const CubeQuery& query, const Box& box) noexcept {
  const Eigen::Vector3d& origin = query.lattice.origin_world;
  return query.possible == nullptr ||
         query.possible->may_meet(box.low + origin, box.high + origin, query.possible_reach_m);
}

bool is_blocked(const CubeQuery& query, const Eigen::Vector3d& x_local, double slack_m) noexcept {
  const Eigen::Vector3d x_world = x_local + query.lattice.origin_world;
  if (query.possible != nullptr && !query.possible->meets(x_world, x_world, query.possible_reach_m + slack_m)) {
    return false;
  }
  bool covered = !query.uncovered_ignored;
  for (std::size_t n = 0; n < query.camera_count; ++n) {
    const LocalCamera& camera = query.cameras[query.order[n]];
    if (!blocks(camera, x_local, slack_m)) {
      return false;
    }
    if (!covered) {
      const Eigen::Vector3d x = camera.to_camera(x_local);
      covered = x.z() > camera.near_m && projects_inside(camera.pinhole, x);
    }
  }
  return covered && in_space(query, x_local);
}

bool is_free(const CubeQuery& query, const Cube& cube, Count& count) noexcept {
  const Box box = box_of(query, cube);
  const Eigen::Vector3d& origin = query.lattice.origin_world;
  if (query.possible != nullptr &&
      !query.possible->meets(box.low + origin, box.high + origin, query.possible_reach_m)) {
    return true;
  }
  const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
  const double half_diagonal_m = 0.5 * (box.high - box.low).norm() + 1e-7;
  bool uncovered = query.uncovered_ignored;
  for (std::size_t n = 0; n < query.camera_count; ++n) {
    const LocalCamera& camera = query.cameras[query.order[n]];
    const Eigen::Vector3d c = camera.to_camera(centre);
    const double pose_error_m =
        camera.has_pose_error ? camera.pose_error(c) + query.lattice.largest_rate * half_diagonal_m : 0.0;
    ++count.ball_tests;
    if (!meets_not_known_free(camera, camera.space, c, half_diagonal_m + pose_error_m)) {
      return true;
    }
    uncovered =
        uncovered && (camera.has_pose_error ? !covers_some(camera, c, half_diagonal_m)
                                            : !meets_not_known_free(camera, camera.coverage, c, half_diagonal_m));
  }
  return uncovered;
}

}  // namespace depthgrid::search
