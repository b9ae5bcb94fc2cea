// Threads that run one step at a time, in the order that a test says: every order is tried, none is left to luck.
//
//   run_interleaved(plan, {[&] { counter.fetch_add(1); }, [&] { counter.fetch_add(1); }});
//
// A step is an operation of a SteppedAtomic, or a call of step(). Memory is that of one thread after the other, so what
// is found is wrong in the order of the steps, not in what a processor makes of them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace depthgrid::test {

/// Before this step, counted over all threads, the thread `to` goes on, unless it has ended.
struct Switch {
  int step = 0;
  std::size_t to = 0;
};

/// Runs all bodies to their ends, each in a thread of its own, the first one first. A body goes on until the plan
/// switches to another or it ends; then the first that has not ended goes on. Gives the number of steps.
int run_interleaved(std::span<const Switch> plan, const std::vector<std::function<void()>>& bodies);

/// Called by the bodies; does nothing elsewhere.
void step() noexcept;

/// Calls check(plan) for every plan of at most `most` switches between so many threads within the first `steps` steps,
/// but for those to the thread that goes on anyway.
template <class Check>
void for_plans(int most, int steps, std::size_t threads, Check&& check) {
  std::vector<Switch> plan;
  const auto extend = [&](const auto& self, int from) -> void {
    check(std::span<const Switch>(plan));
    if (static_cast<int>(plan.size()) == most) {
      return;
    }
    for (int at = from; at < steps; ++at) {
      for (std::size_t to = 0; to < threads; ++to) {
        if (to == (plan.empty() ? 0 : plan.back().to)) {
          continue;
        }
        plan.push_back({at, to});
        self(self, at + 1);
        plan.pop_back();
      }
    }
  };
  extend(extend, 0);
}

/// As much of std::atomic as is needed, each operation a step.
template <class T>
class SteppedAtomic {
 public:
  SteppedAtomic() = default;
  explicit SteppedAtomic(T value) : value_(value) {}
  [[nodiscard]] T load() const noexcept {
    step();
    return value_;
  }
  void store(T value) noexcept {
    step();
    value_ = value;
  }
  T exchange(T value) noexcept {
    step();
    return std::exchange(value_, value);
  }
  T fetch_or(T bits) noexcept {
    step();
    return std::exchange(value_, static_cast<T>(value_ | bits));
  }
  T fetch_add(T more) noexcept {
    step();
    const T before = value_;
    value_ = static_cast<T>(value_ + more);
    return before;
  }
  T fetch_sub(T less) noexcept {
    step();
    const T before = value_;
    value_ = static_cast<T>(value_ - less);
    return before;
  }
  bool compare_exchange_weak(T& expected, T wanted) noexcept {
    step();
    if (value_ == expected) {
      value_ = wanted;
      return true;
    }
    expected = value_;
    return false;
  }

 private:
  T value_{};
};

}  // namespace depthgrid::test
