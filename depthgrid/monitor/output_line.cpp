#include "depthgrid/monitor/output_line.hpp"

#include <ctime>
#include <exception>
#include <utility>

#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {
namespace {

constexpr long kWait_ns = 50'000'000;

timespec soon() noexcept {
  constexpr long kSecond_ns = 1'000'000'000;
  timespec time{};
  (void)::clock_gettime(CLOCK_REALTIME, &time);
  time.tv_nsec += kWait_ns;
  if (time.tv_nsec >= kSecond_ns) {
    time.tv_nsec -= kSecond_ns;
    ++time.tv_sec;
  }
  return time;
}

}  // namespace

OutputLine::OutputLine(std::unique_ptr<Output> output, const CellAnswer& size)
    : output_(std::move(output)), answers_(size) {
  (void)::sem_init(&there_is_one_, 0, 0);
}

OutputLine::~OutputLine() { (void)::sem_destroy(&there_is_one_); }

void OutputLine::put(const CellAnswer& answer) noexcept {
  answers_.back() = answer;  // of the same size, so nothing is allocated
  answers_.publish();
  (void)::sem_post(&there_is_one_);
}

void OutputLine::run(const std::stop_token& stop) noexcept {
  while (!stop.stop_requested()) {
    // A clock that is set only makes this wait longer or shorter once; what is there is taken in any case.
    const timespec until = soon();
    (void)::sem_timedwait(&there_is_one_, &until);
    if (!answers_.take()) {
      continue;
    }
    const CellAnswer& answer = answers_.front();
    if (newest_ > 0) {
      passed_over_.fetch_add(answer.sequence - newest_ - 1, std::memory_order_relaxed);
    }
    newest_ = answer.sequence;
    try {
      output_->take(answer);
      sending_.add(sensors::clock_now_s() - answer.done_s);
    } catch (...) {  // an output that fails must not end the others; what failed it has to say itself
      passed_over_.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace depthgrid::monitor
