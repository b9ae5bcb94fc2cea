// What the tests of the search ask about: a rig, its frames and settings, for the search and for the oracle alike.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "depthgrid/search/search.hpp"
#include "depthgrid/views/view_store.hpp"
#include "reference/random_problem.hpp"
#include "reference/reference.hpp"
#include "support/random_run.hpp"

namespace depthgrid::search {

/// More than doubles err by 1e5 m from the origin, and than the 1e-12 m by which the oracle puts points beyond a
/// border. For lower ends only: what answers must not exceed is compared exactly.
inline constexpr double kDoubleRounding = 1e-9;

/// Copyable; the frames refer to images that somebody else keeps alive.
struct SearchSetup {
  Rig rig;
  std::vector<Frame> frames;
  views::Settings settings;
};

/// Where W comes from.
enum class SpaceKind : std::uint8_t { box, frustum };

/// The random problem with margins of its own for each camera, everything that is not seen free counting as obstacle,
/// and a random resolution. All exposures at one time unless `skewed`. A frustum is that of the problem's principal
/// camera; a box holds all of the problem's points.
SearchSetup make_setup(const reference::RandomProblem& problem, SpaceKind space, bool skewed = false);

/// The same question for the oracle. With `grown_m` every e_k is larger by that: the distance to the grown set is the
/// least that an evaluator may answer which is tight to r = grown_m. `rho_m`: another surveillance radius.
reference::Problem oracle_problem(const SearchSetup& setup, double grown_m = 0, double rho_m = 0);

/// A store that has taken every frame, the snapshot of it, and a search.
class Asker {
 public:
  explicit Asker(const SearchSetup& setup);

  Answer distance(const Capsule& primitive, const Budget& budget = {});
  std::vector<Answer> distances(std::span<const Capsule> primitives, const Budget& budget = {});
  Answer hybrid(const Capsule& primitive) {
    Answer answer;
    search_.hybrid(snapshot_, {&primitive, 1}, {&answer, 1});
    return answer;
  }

  [[nodiscard]] Search& search() { return search_; }
  [[nodiscard]] const views::Snapshot& snapshot() const { return snapshot_; }

 private:
  std::unique_ptr<views::ViewStore> store_;
  Search search_;
  views::Snapshot snapshot_;
};

/// Random problems one after the other until a check fails: check(problem, random), `random` for the test's own
/// choices. A failure names the problem by a line that reference::parse_options() takes.
template <class Check>
void for_random_problems(std::int64_t default_count, const reference::RandomOptions& given, Check&& check) {
  const test::RandomRun run = test::random_run(default_count);
  for (std::int64_t i = 0; i < run.count && !testing::Test::HasFailure(); ++i) {
    reference::RandomOptions options = given;
    options.seed = run.seed + static_cast<std::uint64_t>(i);
    if (!options.width_px) {
      options.width_px = 16 + 8 * static_cast<int>(options.seed % 5);
    }
    const reference::RandomProblem problem = reference::make_random_problem(options);
    reference::Random random(options.seed + 0x5EA4C4);
    const test::RandomRun again{options.seed, 1};
    SCOPED_TRACE("problem " + reference::to_line(options) + "; again with " + again.reproduce());
    check(problem, random);
  }
}

}  // namespace depthgrid::search
