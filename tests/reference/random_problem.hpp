// Random scenes, rigs, frames and control points from a seed: the input of every comparison with the oracle.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "reference/reference.hpp"

namespace depthgrid::reference {

/// Random numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  [[nodiscard]] int integer(int low, int high) {  ///< inclusive
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  [[nodiscard]] bool chance(double probability) { return uniform(0, 1) < probability; }
  [[nodiscard]] Eigen::Vector3d in_cube(double half_m) {
    const double x = uniform(-half_m, half_m);
    const double y = uniform(-half_m, half_m);
    return {x, y, uniform(-half_m, half_m)};
  }
  [[nodiscard]] Eigen::Vector3d direction();

 private:
  std::mt19937_64 engine_;
};

enum class Shape : std::uint8_t { point, sphere, capsule };

/// Everything that is not set is drawn from the seed.
struct RandomOptions {
  std::uint64_t seed = 1;
  std::optional<int> cameras;   ///< 1 or more, the principal one included
  std::optional<int> width_px;  ///< of all images; the height is three quarters of it
  std::optional<double> rho_m;
  std::optional<double> step_m;  ///< depth of a cell of the depth grid
  std::optional<bool> margins;   ///< sensor and pose margins
  std::optional<bool> lateral;   ///< filter radius of at least one pixel; otherwise none
  std::optional<bool> invalid;   ///< some pixels without measurement
  std::optional<bool> robot;     ///< robot capsules with their masks
  std::optional<bool> units;     ///< 16-bit depth in millimetres instead of float metres
  std::optional<bool> outside;   ///< space outside W is an obstacle
  std::optional<bool> thin;      ///< only thin objects
  std::optional<bool> hand;      ///< something right before the robot; not drawn: none unless it is set

  // For make_search_problem() only.
  std::optional<bool> box;             ///< W is a box in the world, else the principal camera's view
  std::optional<bool> unobserved;      ///< space that no camera covers is an obstacle, else ignored
  std::optional<bool> pockets;         ///< robot pixels free a little more than the robot
  std::optional<bool> skew;            ///< the cameras expose at different times
  std::optional<bool> moved;           ///< the cameras do not stand where the rig says
  std::optional<bool> missing;         ///< one camera has not sent an image
  std::optional<double> smallest_m;    ///< the smallest obstacle of all cameras; where there is one, images have holes
  std::optional<double> resolution_m;  ///< of the search
  std::optional<bool> within;          ///< readings within their margin of the robot count as the robot's
  std::optional<Shape> primitive;      ///< of all queries
  std::optional<int> query;            ///< the only query of interest; the others are asked too
};

/// One line that make_random_problem(parse_options(line)) turns into the same problem: "seed=7 cameras=2 robot=1".
std::string to_line(const RandomOptions& options);
/// Throws Error on an unknown word.
RandomOptions parse_options(const std::string& line);

/// Movable, not copyable: the frames refer to the problem's own images.
struct RandomProblem {
  RandomOptions options;
  simulation::Scene scene;
  Rig rig;
  std::size_t principal = 0;
  double d_min_m = 0;
  double step_m = 0.01;
  int cell_count = 0;
  double rho_m = 0.4;
  bool outside_is_obstacle = false;
  bool within_margin = false;  ///< RobotView's, in all frames
  SensorMargin sensor;
  PoseMargin pose;
  std::vector<simulation::View> views;
  std::vector<std::vector<std::uint16_t>> units;
  std::vector<Frame> frames;
  std::vector<Eigen::Vector3d> points_world;

  RandomProblem() = default;
  RandomProblem(RandomProblem&&) = default;
  RandomProblem& operator=(RandomProblem&&) = default;

  /// Sets the frames of all cameras from views and units.
  void refer_frames();
  /// The same for the oracle.
  [[nodiscard]] Problem problem() const;
};

RandomProblem make_random_problem(const RandomOptions& options);

}  // namespace depthgrid::reference
