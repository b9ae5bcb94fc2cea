#include "support/random_run.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <stdexcept>

namespace depthgrid::test {
namespace {

/// Sets a variable of the environment and puts it back.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* text = std::getenv(name)) {
      before_ = text;
    }
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    if (value == nullptr) {
      unsetenv(name_);
    } else {
      setenv(name_, value, 1);
    }
  }

  const char* name_;
  std::optional<std::string> before_;
};

TEST(RandomRun, HasDefaults) {
  const Variable seed("DEPTHGRID_TEST_SEED", nullptr);
  const Variable count("DEPTHGRID_TEST_COUNT", nullptr);
  const Variable divisor("DEPTHGRID_TEST_DIVISOR", nullptr);
  EXPECT_EQ(random_run(77).seed, 1U);
  EXPECT_EQ(random_run(77).count, 77);
}

TEST(RandomRun, ListensToTheEnvironmentAndSaysHowToRepeat) {
  const Variable seed("DEPTHGRID_TEST_SEED", "18446744073709551615");
  const Variable count("DEPTHGRID_TEST_COUNT", "5000000");
  EXPECT_EQ(random_run(77).count, 5'000'000);
  EXPECT_EQ(random_run(77).reproduce(), "DEPTHGRID_TEST_SEED=18446744073709551615 DEPTHGRID_TEST_COUNT=5000000");
}

TEST(RandomRun, ADivisorLeavesAPartOfTheDefaultButNotOfACount) {
  const Variable divisor("DEPTHGRID_TEST_DIVISOR", "10");
  const Variable none("DEPTHGRID_TEST_COUNT", nullptr);
  EXPECT_EQ(random_run(1000).count, 100);
  EXPECT_EQ(random_run(20).count, 5);
  EXPECT_EQ(random_run(3).count, 3);
  const Variable count("DEPTHGRID_TEST_COUNT", "40");
  EXPECT_EQ(random_run(1000).count, 40);
}

TEST(RandomRun, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "x", "1e6", "0", "-3", " 5", "99999999999999999999"}) {
    const Variable count("DEPTHGRID_TEST_COUNT", text);
    EXPECT_THROW((void)random_run(77), std::invalid_argument) << "'" << text << "'";
  }
}

}  // namespace
}  // namespace depthgrid::test
