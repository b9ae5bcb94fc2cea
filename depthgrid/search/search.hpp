// The sound search: the distance from points, spheres and capsules to everything that is not known free.
//
// - Takes: a snapshot, capsules in the world frame, metres.
// - Gives: a lower bound of the distance for each capsule, at most rho, in metres, and the obstacle's nearest point.
// - Errors: none thrown; what is not finite gives not_evaluated.
// - Threads: one Search for each thread, on any number of snapshots.
//
// What is promised, exactly:
//
//   free_k = { x : x projects inside image k and near_k < z_k(x) < g_k(pixel of x) },  N_k = W minus free_k
//   O      = intersection over k of { x in W : some y in N_k minus R_k has |x - y| <= e_k(x) }
//   D(P)   = distance from P to O, capped at rho
//
// Answers never exceed D(P). Tight to r: the nearest point w of an answer below rho has |w - P| = answer (to 1e-5 m)
// and lies within e_k(w) + r of N_k minus R_k for every camera k.
//
// With a memory (docs/memory.md), one more set that O is cut with:
//
//   M      = { x : within reach of a voxel of the memory's set, or of what lies outside of its region }
//   O      = M cut with the above
//
// so that no answer is smaller than without it; the nearest point lies within r of M, too.
//
// A search over the cubes of an octree in W: a cube is dropped when it is known free to one camera alone, with
// everything that errors of pose and time may bring into it. What is found out about cubes is kept for later questions
// to the same snapshot. Answers without a budget depend on the snapshot and the capsule alone, to the bit: not on what
// was asked before, nor on the other capsules of a call, nor on the instruction set.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/capsule.hpp"
#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::search {

/// Subtracted from every answer: covers the rounding of single-precision geometry near the cameras.
inline constexpr double kRounding = 1e-5;

/// Stops a call early. When it runs out the answers that are not finished hold the lower bound reached so far, with
/// nearest.budget set. Nothing: no limit.
struct Budget {
  /// Octree cells that the call may look into, over all capsules, whether they are known from earlier calls or not:
  /// what is answered does not depend on them.
  std::optional<std::int64_t> nodes{};
  std::optional<double> time_s{};  ///< wall clock; looked at every few microseconds
};

/// Work done, for figures.
struct Count {
  std::int64_t nodes = 0;       ///< octree cells opened that were not known from earlier
  std::int64_t ball_tests = 0;  ///< exact tests of a ball against one camera
};

struct Nearest;

/// Octree cells that a Search remembers, 64 bytes each: 4 MiB with the one that stands for none.
inline constexpr std::size_t kRememberedCells = (std::size_t{1} << 16) - 1;

/// What one thread has found out about a snapshot; everything is allocated by the constructor. Not for two threads at
/// once.
class Search {
 public:
  /// For snapshots of any store and calls of any size. With fewer remembered cells calls take longer and answer the
  /// same; only a budget that pays for more cells than are remembered ends early.
  explicit Search(std::size_t remembered_cells = kRememberedCells);
  ~Search();
  Search(Search&&) noexcept;
  Search& operator=(Search&&) noexcept;
  Search(const Search&) = delete;
  Search& operator=(const Search&) = delete;

  /// Distances of many capsules. answers.size() should equal capsules.size(); answers without a capsule, and those of
  /// capsules that are not finite or have a negative radius, are not_evaluated. No time is asked for: distance_now_m
  /// stays NaN. Does not allocate, lock or throw.
  void distances(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
                 const Budget& budget = {}, Count* count = nullptr) noexcept;

  /// The same with a memory of the same store's images; of any time.
  void distances(const views::Snapshot& snapshot, const memory::MemorySnapshot& memory,
                 std::span<const Capsule> capsules, std::span<Answer> answers, const Budget& budget = {},
                 Count* count = nullptr) noexcept;

  /// The same with hybrid_direction_world, equation (11) in its corrected form.
  void hybrid(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
              const Budget& budget = {}, Count* count = nullptr) noexcept;
  void hybrid(const views::Snapshot& snapshot, const memory::MemorySnapshot& memory, std::span<const Capsule> capsules,
              std::span<Answer> answers, const Budget& budget = {}, Count* count = nullptr) noexcept;

 private:
  struct State;
  struct Plan;
  [[nodiscard]] static bool plan(const views::Snapshot& snapshot, const Capsule& capsule, Answer& result,
                                 Plan& plan) noexcept;
  static void finish(const views::Snapshot& snapshot, const Plan& plan, const Nearest& found,
                     const Eigen::Vector3d& origin_world, Answer& result) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::search
