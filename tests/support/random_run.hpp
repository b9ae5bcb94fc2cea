// Seed and number of cases of a random test, from the environment.
#pragma once

#include <cstdint>
#include <string>

namespace depthgrid::test {

/// How a random test runs.
struct RandomRun {
  std::uint64_t seed = 1;
  std::int64_t count = 0;

  /// What to set so that the test runs again as it just did; put it into the failure message.
  [[nodiscard]] std::string reproduce() const;
};

/// DEPTHGRID_TEST_SEED (default 1) and DEPTHGRID_TEST_COUNT (default `default_count`, or where DEPTHGRID_TEST_DIVISOR
/// is set that part of it, for instrumented builds). Throws std::invalid_argument when one of them is set but is not a
/// whole number in range.
[[nodiscard]] RandomRun random_run(std::int64_t default_count);

}  // namespace depthgrid::test
