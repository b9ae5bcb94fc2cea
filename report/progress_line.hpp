// One line on the terminal that says how far a long job is.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace depthgrid::report {

/// Writes to standard error, and only when that is a terminal, at most ten times a second. The line is erased at the
/// end, so that it never mixes with results or errors. One thread only.
class ProgressLine {
 public:
  ProgressLine(std::string label, std::size_t total);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// `done` of the total steps are behind us.
  void update(std::size_t done);
  /// The same, under another label from now on.
  void update(std::size_t done, std::string label);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  std::size_t total_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point begin_;
  Clock::time_point last_shown_;
};

/// "12 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

}  // namespace depthgrid::report
