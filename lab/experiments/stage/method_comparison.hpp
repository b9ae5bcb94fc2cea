// Several methods, with one camera or more, asked for the same points at the same instants, and the truth beside them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/stage/camera_images.hpp"
#include "lab/experiments/stage/distance_method.hpp"
#include "lab/experiments/stage/point_truth.hpp"
#include "lab/experiments/stage/staged_cell.hpp"

namespace depthgrid::experiments {

/// A method with some of the rig's cameras, the principal one first.
struct Candidate {
  std::string label;  ///< in tables and figures; distinct
  EvaluationMethod method = EvaluationMethod::search;
  std::vector<std::size_t> cameras{0};
  RobotPixels robot = RobotPixels::behind_unknown;
};

/// Everything about one instant.
struct Instant {
  double time_s = 0;
  std::uint64_t frame = 0;                      ///< number of the noise
  std::vector<Eigen::Vector3d> points_world;    ///< the arm's control points
  std::vector<PointTruth::Nearest> truth;       ///< one a point
  std::vector<std::vector<Proximity>> answers;  ///< one row a candidate, one answer a point
  double person_to_arm_m = 0;                   ///< real distance from the person to the arm's surface
  std::size_t points_behind_person = 0;  ///< control points whose line of sight to the principal camera is crossed
};

/// How many of the arm's control points the person hides from a camera that stands there (world frame).
[[nodiscard]] std::size_t points_behind_person(const StagedCell& stage, const Eigen::Vector3d& camera_world);

/// One thread.
class MethodComparison {
 public:
  /// `arrangement` says where the space of interest is, `rig` holds the cameras. Throws Error as its parts do and when
  /// a candidate asks for a camera that is none.
  MethodComparison(const StagedCell& stage, const Rig& rig, const simulation::Arrangement& arrangement,
                   std::vector<Candidate> candidates, const simulation::SensorGroupSettings& noise);

  /// Whether a candidate remembers: then instants have to come in the order of their times, and what it sees between
  /// them is taken by pass().
  [[nodiscard]] bool remembers() const noexcept;
  /// The stage stands as it is: images for those that remember, and no answers.
  void pass(const StagedCell& stage, double time_s, std::uint64_t frame);
  /// The images of an instant once more, for pictures. The stage stands as it did then.
  void retake(const StagedCell& stage, const Instant& instant);

  /// The stage stands as it is; `frame` numbers the noise.
  [[nodiscard]] Instant at(const StagedCell& stage, double time_s, std::uint64_t frame);

  /// The images of the last instant; some candidate must have asked for them.
  [[nodiscard]] const CameraImages& images(RobotPixels robot) const { return images_.at(robot); }
  [[nodiscard]] const std::vector<Candidate>& candidates() const noexcept { return candidates_; }

 private:
  void update(std::size_t candidate);

  std::vector<Candidate> candidates_;
  std::vector<DistanceMethod> methods_;
  std::vector<Frame> frames_;  ///< of one candidate
  std::map<RobotPixels, CameraImages> images_;
  PointTruth point_truth_;
  workcell::CellTruth cell_truth_;
};

}  // namespace depthgrid::experiments
