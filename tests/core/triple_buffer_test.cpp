// The newest value from one thread to another: whole, never an older one after a newer, and the last one arrives.
#include "depthgrid/core/triple_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "support/random_run.hpp"

namespace depthgrid {
namespace {

using Numbers = std::array<std::int64_t, 16>;

TEST(TripleBuffer, GivesTheNewestOnce) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.take());
  EXPECT_EQ(buffer.front(), 7);
  for (const int value : {1, 2, 3}) {
    buffer.back() = value;
    buffer.publish();
  }
  EXPECT_TRUE(buffer.take());
  EXPECT_EQ(buffer.front(), 3);
  EXPECT_FALSE(buffer.take());
  EXPECT_EQ(buffer.front(), 3);
}

TEST(TripleBuffer, ValuesAreWholeAndInOrder) {
  const auto run = test::random_run(20000);
  TripleBuffer<Numbers> buffer(Numbers{});
  std::atomic<std::int64_t> read{0};
  std::thread writer([&] {
    for (std::int64_t n = 1; n <= run.count; ++n) {
      buffer.back().fill(n);
      buffer.publish();
      // The reader shall see some of them, on a busy machine too.
      while (n % 100 == 0 && read < n / 100) {
        std::this_thread::yield();
      }
    }
  });
  std::int64_t newest = 0;
  std::int64_t torn = 0;
  std::int64_t back_in_time = 0;
  while (newest < run.count) {
    if (!buffer.take()) {
      std::this_thread::yield();
      continue;
    }
    const Numbers& numbers = buffer.front();
    torn += std::count(numbers.begin(), numbers.end(), numbers[0]) == std::ssize(numbers) ? 0 : 1;
    back_in_time += numbers[0] > newest ? 0 : 1;
    newest = numbers[0];
    ++read;
  }
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(back_in_time, 0);
  EXPECT_FALSE(buffer.take());
}

}  // namespace
}  // namespace depthgrid
