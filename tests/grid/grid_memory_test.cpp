// The corrected grid with a memory: against every cell of every pixel and every voxel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/memory/voxel_set.hpp"
#include "grid/corrected_twin.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::grid {
namespace {

using Eigen::Vector3d;

constexpr double kFastest = 1;  ///< m/s

/// Around the first of the problem's points.
GridMemory memory_of(const RandomProblem& problem) {
  GridMemory memory;
  memory.settings.low_world = problem.points_world[0] - Vector3d::Constant(0.4);
  memory.settings.high_world = problem.points_world[0] + Vector3d::Constant(0.4);
  memory.settings.voxel_m = 0.1;
  memory.settings.start = memory::StartUnknown{};
  memory.margins.resize(problem.rig.cameras.size());
  for (CameraMargins& margins : memory.margins) {
    margins.sensor = problem.sensor;
    margins.translation_m = problem.pose.translation_m;
    margins.rotation_rad = problem.pose.rotation_rad;
    margins.smallest_obstacle_m = 0;
  }
  memory.v_max_m_s = kFastest;
  return memory;
}

EvaluationSettings settings_of(const RandomProblem& problem) {
  EvaluationSettings settings;
  settings.variant = Variant::corrected;
  settings.rho_m = problem.rho_m;
  settings.sensor = problem.sensor;
  settings.pose = problem.pose;
  return settings;
}

/// An image that shows nothing nearer than 20 m.
class Emptiness {
 public:
  explicit Emptiness(const PinholeCamera& c)
      : width_px_(c.width_px),
        height_px_(c.height_px),
        depth_m_(static_cast<std::size_t>(c.width_px) * static_cast<std::size_t>(c.height_px), 20.0F) {}
  [[nodiscard]] Frame frame(double time_s) const { return {depth_view(depth_m_, width_px_, height_px_), {}, time_s}; }

 private:
  int width_px_, height_px_;
  std::vector<float> depth_m_;
};

/// Whether a cell's box lies within reach of a voxel of the set, or of what lies outside of the region.
bool may_hold(const memory::VoxelSet& set, double reach_m, const PixelFrustum& cell, const Pose& T_world_principal) {
  Vector3d low = Vector3d::Constant(1e9);
  Vector3d high = -low;
  for (const double z : {cell.d1_m, cell.d2_m}) {
    for (const double a : {cell.a0, cell.a1}) {
      for (const double b : {cell.b0, cell.b1}) {
        const Vector3d x = T_world_principal * Vector3d(a * z, b * z, z);
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
    }
  }
  if (std::min((low - set.low_world()).minCoeff(), (set.high_world() - high).minCoeff()) <= reach_m) {
    return true;
  }
  for (int k = 0; k < set.voxels()[2]; ++k) {
    for (int j = 0; j < set.voxels()[1]; ++j) {
      for (int i = 0; i < set.voxels()[0]; ++i) {
        const Vector3d from = set.low_world() + set.voxel_m() * Vector3d(i, j, k);
        const Vector3d to = from + Vector3d::Constant(set.voxel_m());
        if (set.contains(i, j, k) && (from - high).cwiseMax(low - to).cwiseMax(0).norm() <= reach_m) {
          return true;
        }
      }
    }
  }
  return false;
}

struct Tally {
  std::int64_t asked = 0, farther = 0, within_rho = 0;
};

/// Everything is seen free, then come the problem's images, a little later: what these hide and nothing can have come
/// to meanwhile is ruled out.
void check(const RandomProblem& problem, reference::Random& random, Tally& tally) {
  const double later_s = random.uniform(0.001, 0.1);
  EvaluationSettings settings = settings_of(problem);
  GridEvaluator without(problem.rig, problem.principal, quantisation_of(problem), settings);
  settings.memory = memory_of(problem);
  GridEvaluator with(problem.rig, problem.principal, quantisation_of(problem), settings);
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    ASSERT_TRUE(with.update(k, Emptiness(problem.rig.cameras[k].intrinsics).frame(1)).taken());
  }
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    Frame frame = problem.frames[k];
    frame.time_s = 1 + later_s;
    ASSERT_TRUE(with.update(k, frame).taken());
    ASSERT_TRUE(without.update(k, frame).taken());
  }
  const memory::MemorySnapshot memory = with.memory()->snapshot();
  const double reach_m = memory.reach_m(1 + later_s);
  const RigCamera& principal = problem.rig.cameras[problem.principal];
  const std::vector<Observation> observations = observe(problem, &problem.sensor);
  for (int i = 0; i < 4; ++i) {
    const Vector3d p_world = problem.points_world[0] + random.in_cube(0.2);
    const Proximity all = without.distance(Capsule::point(p_world)).nearest;
    const Proximity some = with.distance(Capsule::point(p_world)).nearest;
    if (!has_distance(all)) {
      EXPECT_EQ(some.state, all.state);
      continue;
    }
    const double slow = corrected_twin(
        problem, with.grid(), observations, settings, in_principal(problem, p_world),
        [&](const PixelFrustum& c) { return may_hold(memory.voxels(), reach_m, c, principal.T_world_camera); });
    // A blind zone that ends inside a cell is cut exactly by the scan and kept whole by the twin.
    if (principal.rule.near_m > problem.d_min_m) {
      EXPECT_LE(slow, some.distance_m + 1e-9) << p_world.transpose();
    } else {
      EXPECT_NEAR(some.distance_m, slow, 1e-9) << p_world.transpose();
    }
    EXPECT_GE(some.distance_m, all.distance_m);
    ++tally.asked;
    tally.farther += some.distance_m > all.distance_m + 0.01 ? 1 : 0;
    tally.within_rho += slow < settings.rho_m ? 1 : 0;
  }
}

TEST(GridMemory, LeavesTheNearestOfAllCellsThatMayHoldAnything) {
  const test::RandomRun run = test::random_run(24);
  Tally tally;
  for (std::int64_t n = 0; n < run.count && !HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    reference::RandomOptions options;
    options.seed = again.seed;
    reference::Random random(again.seed);
    check(reference::make_random_problem(options), random, tally);
  }
  std::cout << tally.asked << " answers, " << tally.farther << " farther than without memory, " << tally.within_rho
            << " within rho\n";
  EXPECT_TRUE(run.count < 24 || (tally.farther > 5 && tally.within_rho > 20));
}

/// One camera that looks along z; 0.4 m around the world's origin are kept, 1 m before it.
struct Cell {
  Cell() {
    rig.cameras.resize(1);
    rig.cameras[0].id = "cam";
    rig.cameras[0].intrinsics = {64, 48, 60, 60, 32, 24};
    rig.cameras[0].T_world_camera.translation().z() = -1;
    settings.rho_m = 0.3;
    settings.sensor = {0.005, 0, 0, 0};
    GridMemory memory;
    memory.settings.low_world = Vector3d::Constant(-0.2);
    memory.settings.high_world = Vector3d::Constant(0.2);
    memory.settings.start = memory::StartUnknown{};
    memory.margins.resize(1);
    memory.margins[0].sensor = settings.sensor;
    memory.margins[0].smallest_obstacle_m = 0;
    memory.v_max_m_s = kFastest;
    settings.memory = memory;
  }
  [[nodiscard]] GridEvaluator evaluator() const { return {rig, 0, {0.2, 0.01, 0.0, 150}, settings}; }
  Rig rig{.name = "cell", .cameras = {}, .T_floor_world = {}};
  EvaluationSettings settings;
};

const Capsule kMiddle = Capsule::point(Vector3d::Zero());
const std::vector<float> kFar_m(std::size_t{64} * 48, 3.0F);
const std::vector<float> kHand_m(std::size_t{64} * 48, 0.5F);

TEST(GridMemory, KeepsWhatWasSeenFreeUntilSomethingCouldHaveCome) {
  GridEvaluator evaluator = Cell().evaluator();
  ASSERT_TRUE(evaluator.update(0, {depth_view(kFar_m, 64, 48), {}, 5}).taken());
  EXPECT_EQ(evaluator.distance(kMiddle).nearest.state, ProximityState::beyond_rho);
  ASSERT_TRUE(evaluator.update(0, {depth_view(kHand_m, 64, 48), {}, 5.05}).taken());
  // 0.2 m to the border, 0.05 m at 1 m/s; cells are 1 cm deep and 2 cm wide.
  const Proximity nearest = evaluator.distance(kMiddle).nearest;
  EXPECT_LE(nearest.distance_m, 0.15);
  EXPECT_GE(nearest.distance_m, 0.12);
  EXPECT_EQ(nearest.state, ProximityState::occluded);
  const Past past = evaluator.past(nearest);
  EXPECT_EQ(past.state, PastState::possible_again);
  EXPECT_GE(past.possible_since_s, 5.022);
  EXPECT_LE(past.possible_since_s, 5.053);
  EXPECT_EQ(evaluator.impossible().images, 0);
  ASSERT_TRUE(evaluator.update(0, {depth_view(kHand_m, 64, 48), {}, 5.3}).taken());
  EXPECT_EQ(evaluator.distance(kMiddle).nearest.distance_m, 0);
  EvaluationSettings plain = Cell().settings;
  plain.memory.reset();
  GridEvaluator without(Cell().rig, 0, {0.2, 0.01, 0.0, 150}, plain);
  EXPECT_EQ(without.memory(), nullptr);
  ASSERT_TRUE(without.update(0, {depth_view(kHand_m, 64, 48), {}, 5.05}).taken());
  EXPECT_EQ(without.distance(kMiddle).nearest.distance_m, 0);
}

TEST(GridMemory, IsRefusedForTheLetterAndWhereItIsNotStated) {
  const auto refused = [](auto&& change) {
    Cell cell;
    change(cell.settings);
    return test::thrown_message([&] { (void)cell.evaluator(); });
  };
  EXPECT_EQ(refused([](EvaluationSettings&) {}), "");
  EXPECT_NE(
      refused([](EvaluationSettings& s) { s.variant = Variant::letter; }).find("a memory with the variant letter"),
      std::string::npos);
  EXPECT_NE(refused([](EvaluationSettings& s) { s.memory->settings.start = std::monostate{}; }).find("start"),
            std::string::npos);
  EXPECT_NE(refused([](EvaluationSettings& s) { s.memory->margins.clear(); }).find("margins"), std::string::npos);
  EXPECT_NE(refused([](EvaluationSettings& s) { s.memory->v_max_m_s = Proximity::kNaN; }).find("v_max"),
            std::string::npos);
}

TEST(GridMemory, DoesNotAllocate) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  GridEvaluator evaluator = Cell().evaluator();
  const test::AllocationGuard guard;
  for (int n = 0; n < 5; ++n) {
    ASSERT_TRUE(evaluator.update(0, {depth_view(n == 0 ? kFar_m : kHand_m, 64, 48), {}, 5 + 0.01 * n}).taken());
    (void)evaluator.past(evaluator.distance(kMiddle).nearest);
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace depthgrid::grid
