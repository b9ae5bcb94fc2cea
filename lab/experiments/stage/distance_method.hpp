// The ways to compute distances that the experiments compare.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "depthgrid/core/distance_evaluator.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/simulation/arrangement.hpp"

namespace depthgrid::experiments {

enum class EvaluationMethod : std::uint8_t {
  letter,         ///< as printed, minimum distance only
  letter_hybrid,  ///< as printed, with the hybrid vector of equation (11)
  corrected,      ///< the letter's grid with its errors mended, minimum distance only
  search,         ///< the sound search, resolution 5 mm
  search_memory,  ///< the same with what is declared for the sensors and a memory that begins with nothing known
};
[[nodiscard]] std::string_view to_string(EvaluationMethod method) noexcept;

/// All of them look into the letter's space of interest, what the principal camera (the first) sees between d_min and
/// d_max; space outside is ignored, space inside that no camera has seen free is an obstacle. Margins are those of the
/// rig's cameras, poses and times are exact. rho = 0.4 m. With a memory things move by at most kVMax, and frames have
/// to come in the order of their times.
class DistanceMethod {
 public:
  static constexpr double kRho = 0.4;   ///< metres
  static constexpr double kVMax = 2.0;  ///< m/s, of people

  /// `arrangement` says where the space begins and ends. Throws Error when rig or margins are invalid.
  DistanceMethod(EvaluationMethod method, const Rig& rig, const simulation::Arrangement& arrangement);

  /// One frame a camera, in the rig's order. Throws Error when one is unusable.
  void update(std::span<const Frame> frames);

  /// Metres, world frame; as many answers as points. At the time of the newest frames.
  void evaluate(std::span<const Eigen::Vector3d> points_world, std::span<Proximity> answers);

  /// The same of capsules, with all that an answer says.
  void evaluate(std::span<const Capsule> capsules, std::span<Answer> answers);

 private:
  std::unique_ptr<DistanceEvaluator> evaluator_;
  double time_s_ = 0;
  std::vector<Capsule> points_;
  std::vector<Answer> found_;
};

}  // namespace depthgrid::experiments
