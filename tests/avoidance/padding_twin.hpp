// The least padding once more, slowly: every padding that is tested, every cell and every capsule with objects of their
// own, and the definition read off the whole table at the end.
#pragma once

#include <optional>
#include <vector>

#include "depthgrid/avoidance/least_padding.hpp"

namespace depthgrid::avoidance::test {

struct TwinLink {
  std::optional<double> least_m;
  double clear_to_m = 0;  ///< up to the largest padding of the settings
  std::optional<double> covers_from_m;
};

/// One a link of moving_capsules(), in its order. Without memory. `robot_within_m`: as it was used.
[[nodiscard]] std::vector<TwinLink> twin_paddings(const Rig& rig, const robot::RobotModel& model,
                                                  const std::vector<EmptyCell>& cells,
                                                  const LeastPaddingSettings& settings, double robot_within_m);

/// Whether a camera alone frees a place, or without slack has it in the robot's interval, by its pixel in the prepared
/// image; for margins of 0.
enum class PixelSays { frees, leaves, not_in_its_image };
[[nodiscard]] PixelSays pixel_says(const Rig& rig, const robot::RobotModel& model, const EmptyCell& cell,
                                   const LeastPaddingSettings& settings, double padding_m, std::size_t camera,
                                   const Eigen::Vector3d& place_world, double slack_m);

}  // namespace depthgrid::avoidance::test
