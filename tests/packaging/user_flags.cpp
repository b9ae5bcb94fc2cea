// Prints numbers that the library computes, to the last bit. Built with several flags: they are the user's own matter,
// and what the library computes must not depend on them. Inputs are literals that every flag reads alike.
//
// The program brings its own copies of what library and program both take from headers: Eigen's functions and ours. A
// linker that took one of them for the library's would change its numbers.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "depthgrid/avoidance/history_port.hpp"
#include "depthgrid/avoidance/model_limits.hpp"
#include "depthgrid/control/polygon_task.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/core/repulsion_law.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/search/search_evaluator.hpp"

using namespace depthgrid;

namespace {

class Digest {
 public:
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Eigen::Vector3d& p) { add(p.x()), add(p.y()), add(p.z()); }
  void add(const Answer& answer) {
    add(answer.nearest.distance_m), add(answer.distance_now_m), add(answer.nearest.nearest_world);
    add(std::uint64_t{static_cast<std::uint8_t>(answer.nearest.state)});
  }
  void add(std::uint64_t bits) {
    hash_ = (hash_ ^ bits) * 0x100000001b3;  // FNV-1a, a word at a time
    hash_ ^= hash_ >> 29;
  }
  void print(const char* what) const { std::printf("%s %016llx\n", what, static_cast<unsigned long long>(hash_)); }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

// Of values that are literals or exact in every arithmetic: small multiples of powers of two.
double exact(int n) { return n * 0x1p-7; }

void own_use_of_eigen() {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, 16, 16>;
  volatile double sink = 0;
  const Eigen::Isometry3d turned = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  const Eigen::Affine3d scaled = Eigen::Affine3d(turned) * Eigen::Affine3d(turned);
  sink = sink + (turned * turned.inverse() * Eigen::Vector3d(1, 2, 3)).norm() + scaled.translation().norm();
  const Small six = Small::Random(6, 6);
  sink = sink + Eigen::SelfAdjointEigenSolver<Small>(six * six.transpose()).eigenvalues().sum();
  const Rows many = Rows::Random(16, 16);
  const Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, 16, 1> right = many.col(0);
  sink = sink + Eigen::LDLT<Rows>(many * many.transpose()).solve(right).sum();
  sink = sink + Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 3, 2>>(Eigen::Matrix<double, 3, 2>::Random()).rank();
  sink = sink + led_direction(Eigen::Vector3d::UnitX(), Eigen::Vector3d(0.1, 0.2, 0.3), 0.5).y();
  sink = sink + inverse_repulsion(0.1, 0.4, 6.0) + depth_margin_m({}, 1.5);
  sink = sink + LetterDistance({64, 48, 60, 60, 32, 24}, {10, 10, 1}).vector(3, 4, 0.5, 0.75).norm();
}

// Two cameras that look along z and, turned by the right angle about y, along x; images of steps and slopes.
Rig two_cameras() {
  Rig rig;
  for (int k = 0; k < 2; ++k) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.id = k == 0 ? "first" : "second";
    camera.intrinsics = {160, 120, 150.0, 150.0, 80.0, 60.0};
    camera.margins.emplace().smallest_obstacle_m = 0;
    camera.metres_per_unit = 0x1p-10;
  }
  Eigen::Matrix4d turned;
  turned << 0, 0, 1, -1.5, 0, 1, 0, 0, -1, 0, 0, 1.5, 0, 0, 0, 1;
  rig.cameras[1].T_world_camera = Pose(turned);
  return rig;
}
std::vector<std::uint16_t> image(int camera) {
  std::vector<std::uint16_t> pixels(160 * 120);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const bool box = u > 50 + 20 * camera && u < 90 && v > 30 && v < 80;
      pixels[static_cast<std::size_t>(160 * v + u)] = static_cast<std::uint16_t>(box ? 1500 + u : 2600 - 3 * v);
    }
  }
  return pixels;
}
std::vector<Capsule> capsules(bool points) {
  std::vector<Capsule> result;
  for (int k = 0; k < 60; ++k) {
    const Eigen::Vector3d a(exact(9 * k - 270) * 0.25, exact(7 * (k % 11) - 35), 1.25 + exact(5 * (k % 13)));
    const Eigen::Vector3d b = points ? a : Eigen::Vector3d(a.x(), a.y() + 0.125, a.z() + 0.25);
    result.push_back({a, b, points ? 0 : 0.03125});
  }
  return result;
}

void take_images(DistanceEvaluator& evaluator) {
  for (int k = 0; k < 2; ++k) {
    const std::vector<std::uint16_t> pixels = image(k);
    if (!evaluator.update(static_cast<std::size_t>(k), {depth_view(pixels, 160, 120, 0x1p-10), {}, 0.0}).taken()) {
      throw Error("image not taken");
    }
  }
}

views::Settings search_settings(const Rig& rig) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.0, 0.25}, {1.5, 1.0, 3.0}};
  settings.policies = {.unobserved = views::Policy::obstacle,
                       .outside = views::Policy::obstacle,
                       .robot_pockets = views::Policy::obstacle};
  settings.margins = camera_margins(rig);
  settings.v_max_m_s = 1.0;
  return settings;
}

void distances() {
  const Rig rig = two_cameras();
  search::SearchEvaluator search(rig, search_settings(rig), {.directions = 20});
  take_images(search);
  std::vector<Answer> answers(60);
  search.evaluate(capsules(false), 0.03125, answers);
  Digest digest;
  for (const Answer& answer : answers) digest.add(answer);
  digest.print("search");

  for (const grid::Variant variant : {grid::Variant::letter, grid::Variant::corrected}) {
    grid::EvaluationSettings settings;
    settings.variant = variant;
    settings.collect = grid::Collect::hybrid;
    grid::GridEvaluator grid(rig, 0, {.d_min_m = 0.25, .step_m = 0x1p-6, .growth = 0, .count = 180}, settings);
    take_images(grid);
    grid.evaluate(capsules(true), 0.0, answers);
    Digest letter;
    for (const Answer& answer : answers) letter.add(answer), letter.add(answer.hybrid_direction_world);
    letter.print(variant == grid::Variant::letter ? "letter" : "corrected");
  }
}

void kinematics() {
  const robot::RobotModel model = robot::kuka_lwr4();
  std::vector<Pose> poses(model.links().size());
  robot::Jacobian jacobian(6, 7);
  Digest digest;
  for (int k = 0; k < 50; ++k) {
    std::array<double, 7> q{};
    for (int j = 0; j < 7; ++j) q[static_cast<std::size_t>(j)] = exact((37 * k + 53 * j) % 201 - 100);
    if (!model.link_poses(q, Pose::Identity(), poses) ||
        !model.jacobian(q, poses, 7, poses[7].translation(), jacobian)) {
      throw Error("no kinematics");
    }
    for (const Pose& pose : poses) {
      for (const double entry : pose.matrix().reshaped()) digest.add(entry);
    }
    for (const double entry : jacobian.reshaped()) digest.add(entry);
  }
  digest.print("kinematics");
}

// The whole loop: kinematics, distances, repulsion, saturation, commands.
void loop() {
  const robot::PlacedRobot robot{robot::kuka_lwr4(), Pose(Eigen::Translation3d(0, -0.25, 1.0))};
  avoidance::LoopSettings settings;
  settings.parts = tip_first(moving_capsules(robot.model), robot.model.link_index("lwr_7_link"));
  settings.controller.limits = avoidance::joint_limits(robot.model, 5.0);
  settings.controller.period_s = 0x1p-9;
  settings.controller.body.law = control::BodyLaw::approach_row;
  settings.end_effector_limits = true;
  settings.evaluate_every = 5;
  control::JointVector q_start(7);
  q_start << 0.25, 0.5, -0.25, -1.0, 0.125, 0.75, 0.0;
  settings.controller.posture_rad = q_start;
  const Eigen::Vector3d start = robot.link_poses({q_start.data(), 7})[settings.parts[0].link].translation();
  control::PolygonTask task({.vertices_world = {start, start - Eigen::Vector3d(0, 0, 0.25)}, .speed_m_s = 0.25});
  const Rig rig = two_cameras();
  search::SearchEvaluator evaluator(rig, search_settings(rig), {.directions = 1});
  take_images(evaluator);
  robot::JointHistory history(7, 1000, 0.02, 0.01);
  control::SimulatedArm arm(settings.controller.limits, settings.controller.period_s, q_start);
  avoidance::HistoryPort port(arm, history);
  avoidance::AvoidanceLoop loop(robot, task, evaluator, settings);
  if (!loop.start(port)) throw Error("the loop does not start");
  Digest digest;
  double fastest = 0;
  for (int k = 0; k < 300; ++k) {
    if (!loop.cycle(port, 1e-6 * k)) throw Error("the loop does not go on");
    for (const double v : loop.report().output.command.velocity_rad_s) {
      digest.add(v);
      fastest = std::max(fastest, std::abs(v));
    }
    for (const Answer& answer : loop.answers()) digest.add(answer);
    arm.advance();
  }
  digest.print("loop");
  if (fastest == 0) throw Error("the arm never moved: its commands say nothing");
}

}  // namespace

int main() try {
  own_use_of_eigen();
  distances();
  kinematics();
  loop();
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
