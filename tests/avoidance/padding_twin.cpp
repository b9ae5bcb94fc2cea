#include "avoidance/padding_twin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "depthgrid/robot/robot_parts.hpp"
#include "depthgrid/search/search.hpp"

namespace depthgrid::avoidance::test {

namespace {

/// A store that has seen the cell with the robot taken out.
class SeenCell {
 public:
  SeenCell(const Rig& rig, const robot::RobotModel& model, const EmptyCell& cell, const LeastPaddingSettings& settings,
           double padding_m)
      : store_(rig, settings.search) {
    robot::RemovalSettings removal = settings.removal;
    removal.padding_m = padding_m;
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      robot::RobotRemoval& robot = *removals_.emplace_back(std::make_unique<robot::RobotRemoval>(
          rig.cameras[k].intrinsics, robot::link_capsules(model, settings.capsules), removal));
      Frame frame = cell.seen[k];
      frame.robot = robot.find(cell.T_world_link, rig.cameras[k].T_world_camera, cell.motion_m, &frame.depth);
      robots_.push_back(frame.robot);
      EXPECT_TRUE(store_.update(k, frame).taken());
    }
  }
  /// The robot's interval is never an obstacle, whatever the pixel reads.
  [[nodiscard]] bool is_robot(std::size_t camera, int u, int v, double z_m) const {
    const RobotView& robot = robots_[camera];
    const auto at = v * robot.stride_px + u;
    return robot.near_m[at] > 0 && z_m >= static_cast<double>(robot.near_m[at]) &&
           z_m <= static_cast<double>(robot.far_m[at]);
  }
  [[nodiscard]] views::Snapshot snapshot() const { return store_.snapshot(); }

 private:
  views::ViewStore store_;
  std::vector<std::unique_ptr<robot::RobotRemoval>> removals_;
  std::vector<RobotView> robots_;
};

/// A row of the table.
struct Row {
  double padding_m = 0;
  double blind_m = 0;
  bool enough = true;
  std::vector<double> unknown_from_m;  ///< of the cells without enough
};

Row row_of(const Rig& rig, const robot::RobotModel& model, const std::vector<EmptyCell>& cells,
           const LeastPaddingSettings& settings, std::size_t link, double padding_m) {
  Row row{padding_m, 0, true, {}};
  for (const EmptyCell& cell : cells) {
    const SeenCell seen(rig, model, cell, settings, padding_m);
    double least_left_m = std::numeric_limits<double>::infinity();
    double unknown_from_m = 0;
    for (const robot::LinkCapsule& part : robot::moving_capsules(model, settings.least_joints, settings.capsules)) {
      if (part.link != link) {
        continue;
      }
      const Pose& T = cell.T_world_link[link];
      const Capsule capsule{T * part.capsule.a, T * part.capsule.b, part.capsule.radius_m};
      Answer answer;
      search::Search().distances(seen.snapshot(), {&capsule, 1}, {&answer, 1});
      const Proximity& nearest = answer.nearest;
      // A lower bound of the distance to everything, the border of what is known included.
      const double known_m =
          std::isnan(nearest.known_to_m) ? nearest.distance_m : std::min(nearest.distance_m, nearest.known_to_m);
      const double left_m = known_m - answer.blind_m;
      row.blind_m = std::max(row.blind_m, answer.blind_m);
      if (left_m < least_left_m) {
        least_left_m = left_m;
        unknown_from_m = std::max(nearest.distance_m, answer.blind_m);
      }
    }
    if (!(least_left_m >= settings.clearance_m)) {
      row.enough = false;
      row.unknown_from_m.push_back(unknown_from_m);
    }
  }
  return row;
}

TwinLink read_off(const std::vector<Row>& rows, double robot_within_m) {
  TwinLink link;
  for (std::size_t p = 0; p < rows.size(); ++p) {
    bool covers = false;
    for (std::size_t q = 0; q <= p; ++q) {
      for (const double u_m : rows[q].unknown_from_m) {
        covers = covers || (u_m > robot_within_m && u_m <= rows[p].blind_m);
      }
    }
    if (covers && !link.covers_from_m) {
      link.covers_from_m = rows[p].padding_m;
    }
    if (rows[p].enough && !covers) {
      link.least_m = rows[p].padding_m;
      for (std::size_t q = p; q < rows.size() && rows[q].enough; ++q) {
        link.clear_to_m = rows[q].padding_m;
      }
      return link;
    }
  }
  return link;
}

}  // namespace

std::vector<TwinLink> twin_paddings(const Rig& rig, const robot::RobotModel& model, const std::vector<EmptyCell>& cells,
                                    const LeastPaddingSettings& settings, double robot_within_m) {
  std::vector<std::size_t> links;
  for (const robot::LinkCapsule& part : robot::moving_capsules(model, settings.least_joints, settings.capsules)) {
    if (links.empty() || links.back() != part.link) {
      links.push_back(part.link);
    }
  }
  std::vector<TwinLink> result;
  for (const std::size_t link : links) {
    std::vector<Row> rows;
    for (const double padding_m : settings.paddings_m) {
      rows.push_back(row_of(rig, model, cells, settings, link, padding_m));
    }
    result.push_back(read_off(rows, robot_within_m));
  }
  return result;
}

PixelSays pixel_says(const Rig& rig, const robot::RobotModel& model, const EmptyCell& cell,
                     const LeastPaddingSettings& settings, double padding_m, std::size_t camera,
                     const Eigen::Vector3d& place_world, double slack_m) {
  const SeenCell seen(rig, model, cell, settings, padding_m);
  const views::Snapshot snapshot = seen.snapshot();
  const RigCamera& setup = rig.cameras[camera];
  const Eigen::Vector3d x = setup.T_world_camera.inverse(Eigen::Isometry) * place_world;
  const DepthPoint at = project(setup.intrinsics, x);
  if (!(x.z() > 0) ||
      !setup.intrinsics.contains(static_cast<int>(std::floor(at.x_px)), static_cast<int>(std::floor(at.y_px)))) {
    return PixelSays::not_in_its_image;
  }
  if (slack_m == 0 && seen.is_robot(camera, static_cast<int>(at.x_px), static_cast<int>(at.y_px), x.z())) {
    return PixelSays::frees;
  }
  const double beside_px = slack_m * setup.intrinsics.fx_px / x.z();
  for (int v = static_cast<int>(std::floor(at.y_px - beside_px)); v <= static_cast<int>(at.y_px + beside_px); ++v) {
    for (int u = static_cast<int>(std::floor(at.x_px - beside_px)); u <= static_cast<int>(at.x_px + beside_px); ++u) {
      if (!setup.intrinsics.contains(u, v) ||
          x.z() + slack_m >= static_cast<double>(snapshot.view(camera).free_m(u, v))) {
        return PixelSays::leaves;
      }
    }
  }
  return PixelSays::frees;
}

}  // namespace depthgrid::avoidance::test
