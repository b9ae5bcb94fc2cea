#include "support/random_run.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace depthgrid::test {
namespace {

/// What a divisor leaves at least.
constexpr std::int64_t kFewest = 5;

template <class Integer>
Integer from_environment(const char* name, Integer default_value, Integer smallest) {
  const char* text = std::getenv(name);
  if (text == nullptr) {
    return default_value;
  }
  const std::string_view digits(text);
  Integer value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value < smallest) {
    throw std::invalid_argument(std::string(name) + " is '" + text + "', must be a whole number from " +
                                std::to_string(smallest));
  }
  return value;
}

}  // namespace

std::string RandomRun::reproduce() const {
  return "DEPTHGRID_TEST_SEED=" + std::to_string(seed) + " DEPTHGRID_TEST_COUNT=" + std::to_string(count);
}

RandomRun random_run(std::int64_t default_count) {
  const auto divisor = from_environment<std::int64_t>("DEPTHGRID_TEST_DIVISOR", 1, 1);
  const std::int64_t fewer = std::max(default_count / divisor, std::min<std::int64_t>(default_count, kFewest));
  return {from_environment<std::uint64_t>("DEPTHGRID_TEST_SEED", 1, 0),
          from_environment<std::int64_t>("DEPTHGRID_TEST_COUNT", fewer, 1)};
}

}  // namespace depthgrid::test
