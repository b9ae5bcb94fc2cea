// One output of a running cell, in a thread of its own that the asking thread never waits for. Internal.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "depthgrid/core/triple_buffer.hpp"
#include "depthgrid/monitor/cell_answer.hpp"
#include "depthgrid/monitor/monitor.hpp"
#include "depthgrid/monitor/time_histogram.hpp"

namespace depthgrid::monitor {

class OutputLine {
 public:
  /// `size`: an answer of the final size.
  OutputLine(std::unique_ptr<Output> output, const CellAnswer& size);
  ~OutputLine();
  OutputLine(const OutputLine&) = delete;
  OutputLine& operator=(const OutputLine&) = delete;

  /// The asking thread's: waits, locks and allocates nothing.
  void put(const CellAnswer& answer) noexcept;
  /// Until it is told to stop.
  void run(const std::stop_token& stop) noexcept;

  /// From the answer to the output's being done with it.
  [[nodiscard]] const TimeHistogram& sending() const noexcept { return sending_; }
  [[nodiscard]] std::uint64_t passed_over() const noexcept { return passed_over_.load(std::memory_order_relaxed); }

 private:
  std::unique_ptr<Output> output_;
  TripleBuffer<CellAnswer> answers_;
  sem_t there_is_one_{};
  std::uint64_t newest_ = 0;
  TimeHistogram sending_;
  std::atomic<std::uint64_t> passed_over_{0};
};

}  // namespace depthgrid::monitor
