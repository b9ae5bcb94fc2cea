// Every instruction set that this machine has gives the same answers, bit for bit.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <vector>

#include "search/answer_bits.hpp"
#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Random;
using reference::RandomProblem;

/// Chooses an instruction set for the dynamic dispatch, and gives the choice back at the end.
class Target {
 public:
  explicit Target(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ~Target() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
};

SearchSetup random_setup(const RandomProblem& problem, Random& random) {
  SearchSetup setup = make_setup(problem, random.chance(0.5) ? SpaceKind::box : SpaceKind::frustum, true);
  if (random.chance(0.5)) {
    setup.settings.policies.unobserved = views::Policy::ignored;
  }
  if (random.chance(0.5)) {
    setup.settings.policies.outside = views::Policy::ignored;
  }
  for (RigCamera& camera : setup.rig.cameras) {
    camera.rule.near_m = random.chance(0.3) ? random.uniform(0.2, 1.0) : camera.rule.near_m;
  }
  return setup;
}

std::vector<Capsule> random_primitives(const RandomProblem& problem, Random& random) {
  std::vector<Capsule> primitives;
  for (const Vector3d& p_world : problem.points_world) {
    primitives.push_back(Capsule::point(p_world));
    primitives.push_back(Capsule::sphere(p_world + random.in_cube(0.1), random.uniform(0, 0.1)));
    primitives.push_back(Capsule{p_world, p_world + random.in_cube(0.3), random.uniform(0, 0.1)});
  }
  return primitives;
}

/// Every number of the answers to one random problem, and the work done.
std::vector<std::uint64_t> answer_everything(std::uint64_t seed, bool hybrid) {
  std::vector<std::uint64_t> all;
  reference::RandomOptions options;
  options.seed = seed;
  // Sides that are no multiple of any vector's width as well.
  options.width_px = 16 + 4 * static_cast<int>(options.seed % 13);
  const RandomProblem problem = reference::make_random_problem(options);
  Random random(options.seed);
  Asker asker(random_setup(problem, random));
  const std::vector<Capsule> primitives = random_primitives(problem, random);
  std::vector<Answer> answers(primitives.size());
  Count count;
  for (const Budget& budget : {Budget{}, Budget{.nodes = 40}}) {
    if (hybrid) {
      asker.search().hybrid(asker.snapshot(), primitives, answers, budget, &count);
    } else {
      asker.search().distances(asker.snapshot(), primitives, answers, budget, &count);
    }
    for (const Answer& answer : answers) {
      const std::vector<std::uint64_t> bits = bits_of(answer);
      all.insert(all.end(), bits.begin(), bits.end());
    }
  }
  all.push_back(static_cast<std::uint64_t>(count.nodes));
  return all;
}

void expect_the_same_from_all(bool hybrid) {
  const test::RandomRun run = test::random_run(hybrid ? 60 : 150);
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  std::vector<std::vector<std::uint64_t>> first;
  std::string names;
  for (const std::int64_t target : targets) {
    const Target chosen(target);
    names += std::string(names.empty() ? "" : ", ") + hwy::TargetName(target);
    int different = 0;
    for (std::int64_t i = 0; i < run.count; ++i) {
      const std::uint64_t seed = run.seed + static_cast<std::uint64_t>(i);
      const std::vector<std::uint64_t> bits = answer_everything(seed, hybrid);
      if (target == targets.front()) {
        first.push_back(bits);
      } else if (bits != first[static_cast<std::size_t>(i)] && ++different == 1) {
        ADD_FAILURE() << hwy::TargetName(target) << " answers otherwise than " << hwy::TargetName(targets.front())
                      << "; again with " << test::RandomRun{seed, 1}.reproduce();
      }
    }
    EXPECT_EQ(different, 0) << "of " << run.count << " problems with " << hwy::TargetName(target);
  }
  std::cout << "  instruction sets: " << names << '\n';
}

TEST(InstructionSets, GiveTheSameDistances) { expect_the_same_from_all(false); }

TEST(InstructionSets, GiveTheSameHybridAnswers) { expect_the_same_from_all(true); }

TEST(InstructionSets, ThatThisMachineHasAreTried) {
#if HWY_ARCH_X86
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  const auto tried = [&](std::int64_t target) {
    return std::find(targets.begin(), targets.end(), target) != targets.end();
  };
  // Instrumented builds leave both out.
  const bool left_out = (HWY_DISABLED_TARGETS & HWY_SSE4) != 0;
  EXPECT_TRUE(left_out || tried(HWY_SSSE3) || tried(HWY_SSE4)) << "the baseline";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    EXPECT_TRUE(tried(HWY_AVX2)) << "the processor has it";
    EXPECT_GT(targets.size(), 1U);
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd")) {
    EXPECT_TRUE(tried(HWY_AVX3)) << "the processor has it";
  }
#else
  GTEST_SKIP() << "names of other processors' instruction sets are not known here";
#endif
}

}  // namespace
}  // namespace depthgrid::search
