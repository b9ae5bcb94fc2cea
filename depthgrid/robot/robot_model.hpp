// A robot's links and joints, where the links are at given joint positions, and how they move.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/robot/robot_description.hpp"

namespace depthgrid::robot {

/// A joint that has a position of its own (neither fixed nor a mimic of another). One element of q.
struct Joint {
  std::string name;
  JointType type = JointType::revolute;
  double lower = 0;      ///< rad, or m where prismatic; -infinity where continuous
  double upper = 0;      ///< infinity where continuous
  double max_speed = 0;  ///< rad/s or m/s; infinity where the description states none
};

/// How a link hangs on its parent.
struct LinkJoint {
  std::optional<std::size_t> parent;                     ///< link; none for the root
  JointType type = JointType::fixed;                     ///< `fixed` for the root
  Eigen::Vector3d axis_link = Eigen::Vector3d::UnitX();  ///< unit, in the link's frame
  std::optional<std::size_t> joint;                      ///< which element of q moves it; none where fixed
  double multiplier = 1;                                 ///< position = multiplier q + offset (mimic joints)
  double offset = 0;
};

/// Rows 0-2: velocity of the point, m/s; rows 3-5: angular velocity of the link, rad/s; world frame; one column a
/// joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign>;

/// Never changes after construction; const members may be called from many threads at once and allocate nothing. Copies
/// share what they hold.
/// Links are numbered depth first from the root, children in the order of their joints' names, so parents come first;
/// joints in the order in which they are met on this way. For a serial arm that is from the base to the tip.
class RobotModel {
 public:
  /// Throws Error, beginning with the description's source, when the links are no tree (see link_tree.hpp), a limit is
  /// not a number, the lower one exceeds the upper one, a speed is not positive, an axis is zero, or a mimic joint
  /// follows one that is not there or follows another itself.
  explicit RobotModel(RobotDescription description);

  [[nodiscard]] const std::string& name() const noexcept;
  [[nodiscard]] const std::string& source() const noexcept;
  [[nodiscard]] const std::vector<Joint>& joints() const noexcept;
  /// With their shapes, in the order of the link numbers.
  [[nodiscard]] const std::vector<LinkDescription>& links() const noexcept;
  [[nodiscard]] const LinkJoint& joint_of_link(std::size_t link) const noexcept;
  /// Throws Error when there is no link of that name.
  [[nodiscard]] std::size_t link_index(std::string_view link) const;

  /// Poses of all links. q: one position a joint, rad or m, limits not enforced; T_world_link: one a link. False, and
  /// nothing written, when a size is wrong; NaN in gives NaN out.
  [[nodiscard]] bool link_poses(std::span<const double> q, const Pose& T_world_base,
                                std::span<Pose> T_world_link) const noexcept;

  /// Geometric Jacobian of the point p_world that is fixed to `link`: jacobian * dq/dt is the point's velocity above
  /// the link's angular velocity. T_world_link as link_poses() gave it for the same q. False, and nothing written, when
  /// a size is wrong: `jacobian` has one column a joint.
  [[nodiscard]] bool jacobian(std::span<const double> q, std::span<const Pose> T_world_link, std::size_t link,
                              const Eigen::Vector3d& p_world, Eigen::Ref<Jacobian> jacobian) const noexcept;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace depthgrid::robot
