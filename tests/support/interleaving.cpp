#include "support/interleaving.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace depthgrid::test {
namespace {

/// Who goes on. One at a time holds the baton.
class Baton {
 public:
  Baton(std::span<const Switch> plan, std::size_t threads) : plan_(plan), ended_(threads, false) {}

  void wait_for_first_turn(std::size_t self) {
    std::unique_lock lock(mutex_);
    turned_.wait(lock, [&] { return holder_ == self; });
  }

  void step(std::size_t self) {
    std::unique_lock lock(mutex_);
    for (; next_ < plan_.size() && plan_[next_].step <= steps_; ++next_) {
      if (!ended_[plan_[next_].to]) {
        holder_ = plan_[next_].to;
      }
    }
    ++steps_;
    if (holder_ != self) {
      turned_.notify_all();
      turned_.wait(lock, [&] { return holder_ == self; });
    }
  }

  void end(std::size_t self) {
    const std::lock_guard lock(mutex_);
    ended_[self] = true;
    holder_ = static_cast<std::size_t>(std::find(ended_.begin(), ended_.end(), false) - ended_.begin());
    turned_.notify_all();
  }

  [[nodiscard]] int steps() const { return steps_; }

 private:
  std::mutex mutex_;
  std::condition_variable turned_;
  std::span<const Switch> plan_;
  std::vector<bool> ended_;
  std::size_t next_ = 0;
  std::size_t holder_ = 0;
  int steps_ = 0;
};

thread_local Baton* baton_of_thread = nullptr;
thread_local std::size_t number_of_thread = 0;

}  // namespace

int run_interleaved(std::span<const Switch> plan, const std::vector<std::function<void()>>& bodies) {
  Baton baton(plan, bodies.size());
  std::vector<std::thread> threads;
  threads.reserve(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    threads.emplace_back([&baton, &bodies, i] {
      baton_of_thread = &baton;
      number_of_thread = i;
      baton.wait_for_first_turn(i);
      bodies[i]();
      baton.end(i);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  return baton.steps();
}

void step() noexcept {
  if (baton_of_thread != nullptr) {
    baton_of_thread->step(number_of_thread);
  }
}

}  // namespace depthgrid::test
