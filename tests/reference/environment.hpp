// Seed and number of random cases, from the environment.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace depthgrid::reference {

inline std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): tests read it before any thread starts
  return text == nullptr ? otherwise : std::stoull(text);
}
inline std::uint64_t test_seed() { return from_environment("DEPTHGRID_TEST_SEED", 1); }
inline std::uint64_t test_count(std::uint64_t otherwise) { return from_environment("DEPTHGRID_TEST_COUNT", otherwise); }

}  // namespace depthgrid::reference
