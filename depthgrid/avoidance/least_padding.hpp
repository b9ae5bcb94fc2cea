// The least padding at which each link of the robot is clear in its cell, found with nobody there before the loop
// starts; and which link and which camera decide it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_model.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::avoidance {

/// One image of every camera with nobody there, the robot standing still. Not owned: the pixels must outlive the call.
struct EmptyCell {
  std::vector<Frame> seen;         ///< in the rig's order; their robot is not looked at
  std::vector<Pose> T_world_link;  ///< RobotModel::link_poses() at the exposure
  std::vector<double> motion_m;    ///< further padding, one a capsule of the robot (motion_padding()); empty: none
};

/// From `first_m` to `last_m`, both included.
[[nodiscard]] std::vector<double> padding_ladder(double first_m, double last_m, double step_m);

struct LeastPaddingSettings {
  views::Settings search{};              ///< as the loop's; rho_m at least the thickest layer and clearance_m
  search::EvaluatorOptions evaluator{};  ///< as the loop's memory and greatest age; directions and budget do not count
  robot::RemovalSettings removal{};      ///< as the loop's; its padding does not count
  robot::CapsuleOptions capsules{};      ///< of the robot
  int least_joints = 2;                  ///< links that fewer joints move are not asked for (moving_capsules())
  /// What is tested, ascending. By default 1 to 20 cm in steps of 5 mm: no model and no camera is better than 1 cm, a
  /// layer of more than 20 cm hides a forearm, and 5 mm are what the search resolves by default. No step may be more
  /// than clearance_m: it could jump over what stands there.
  std::vector<double> paddings_m = padding_ladder(0.01, 0.20, 0.005);
  /// What has to be left between the layer and whatever is nearest, at the time of the images. By default the loop's
  /// laws let a link approach from 5 cm on, with 0.1 m/s at 10 cm: with less the arm hardly moves although nobody is
  /// there. They get v_max times the images' age less, so add that where what is near is not the robot itself.
  double clearance_m = 0.10;
  /// What is nearer to a link than this may be the robot: what the declared errors explain. Nothing: robot_within_m().
  std::optional<double> robot_within_m{};
  std::size_t warm_up = 0;  ///< of the cells, the first that only fill the memory; less than all
};

/// How far from its capsules the robot itself may seem to be: 2 cm for the model and twice the sensor's margin at
/// `reach_m` (a reading errs by it, and frees no more than it less), e_k with half the exposure and the clock's error,
/// half a pixel's diagonal for each end of the filter's window and the pixel itself, and half the smallest obstacle, by
/// which a hole counts as nearer. Of the worst camera.
[[nodiscard]] double robot_within_m(const Rig& rig, const views::Settings& settings, double reach_m);

/// What one camera says of a place that is not known free.
struct CameraSays {
  std::size_t camera = 0;
  /// `unobserved`: it does not look there. `beyond_rho`: it alone sees it free.
  ProximityState state = ProximityState::not_evaluated;
  Unmeasured unmeasured = Unmeasured::not_told;
  bool behind_robot = false;  ///< at `occluded`: the padded robot is before the place
};

/// Why a link was not clear at a padding: the cell where least was left.
struct NotClear {
  double padding_m = 0;
  std::size_t cell = 0;
  Answer answer;               ///< of the link's nearest capsule
  bool at_the_border = false;  ///< nothing was nearer than the border of the space of interest
  std::vector<CameraSays> cameras;
  /// The camera that with the least padding sees the place free or has it in its layer, the one with most around it.
  /// None: no camera does, the memory or the space of interest does, or the link is not clear there either.
  std::optional<std::size_t> decides{};
};

struct LinkPadding {
  std::size_t link = 0;
  std::string name;
  std::optional<double> least_m;    ///< none: no tested padding clears it
  double clear_to_m = 0;            ///< the last of the tested paddings from least_m on that all leave it enough
  double tested_to_m = 0;           ///< the largest padding that was tested for it
  std::optional<NotClear> before;   ///< at the largest smaller padding; with none that clears: at the last tested
  std::optional<NotClear> after{};  ///< what ended it at the padding after clear_to_m, where that is too little for
                                    ///< others
  /// From this padding on a layer that clears it would cover what is no part of the robot.
  std::optional<double> covers_from_m{};
};

struct LeastPadding {
  std::vector<LinkPadding> links;      ///< in the order of moving_capsules()
  std::optional<std::size_t> decides;  ///< in `links`: the largest least_m; none: no link is clear at any padding
  /// The padding to use: that of the deciding link, where it clears all other links that any padding clears. None: it
  /// does not.
  std::optional<double> padding_m;
  double blind_m = 0;         ///< the layer's thickness with that
  double robot_within_m = 0;  ///< as used
};

/// **A link has enough left** at a padding p when in every cell clear_of_layer_m() of each of its capsules, at the time
/// of the images, is at least clearance_m: a thicker layer has to be left alone by as much, so what it hides has to
/// vanish, too, before hiding more helps. The loop's laws get v_max times the images' age less.
///
/// **It is clear** when, besides, its layer covers nothing that is no part of the robot. At a smaller padding without
/// enough left nothing is known nearer than u = max(distance, blind_m); u must be at most robot_within_m (what is so
/// near may be the robot), or more than blind_m now (then a camera has seen free what was there). So, as far as blind_m
/// holds (docs/robot.md), what a padding covers at links that are clear is no farther from them than robot_within_m and
/// one step of the layers. Links that are not asked for have layers, too, which nothing watches.
///
/// Clear is not monotone in p: a layer that grows comes near to what really stands there. So the least is that of the
/// first run of tested paddings that all clear the link, and clear_to_m is its end. The padding to use lies in the runs
/// of all links that have one; a link that has none is told with its reason and decides nothing.
///
/// Takes: a rig without distortion; the model in the same world as the cells. Throws Error where these do not fit
/// together, a frame cannot be used, rho_m is less than the layer and the clearance, or robot_within_m less than the
/// layer of the smallest padding. For the time before the start: it allocates, and takes for each padding and cell what
/// removal, images and answers take.
[[nodiscard]] LeastPadding least_padding(const Rig& rig, const robot::RobotModel& model,
                                         std::span<const EmptyCell> cells, const LeastPaddingSettings& settings);

/// A line a link, and sentences that name the padding to use, the link and the camera that decide, and the links that
/// are not clear. Metres; places in the world, moved by `T_output_world`.
[[nodiscard]] std::string to_string(const LeastPadding& found, const Rig& rig,
                                    const Pose& T_output_world = Pose::Identity());

}  // namespace depthgrid::avoidance
