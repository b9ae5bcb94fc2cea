#include "report/progress_line.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace depthgrid::report {

namespace {

constexpr const char* kEraseLine = "\r\033[K";

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::ceil(seconds)));
  const auto two_digits = [](long n) {
    std::string text = std::to_string(n);
    return text.size() < 2 ? text.insert(0, 1, '0') : text;
  };
  if (whole < 60) {
    return std::to_string(whole) + " s";
  }
  if (whole < 3600) {
    return std::to_string(whole / 60) + " min " + two_digits(whole % 60) + " s";
  }
  return std::to_string(whole / 3600) + " h " + two_digits(whole % 3600 / 60) + " min";
}

ProgressLine::ProgressLine(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), terminal_(::isatty(STDERR_FILENO) == 1), begin_(Clock::now()) {}

ProgressLine::~ProgressLine() {
  if (shown_) {
    (void)std::fputs(kEraseLine, stderr);
  }
}

void ProgressLine::update(std::size_t done, std::string label) {
  label_ = std::move(label);
  update(done);
}

void ProgressLine::update(std::size_t done) {
  const auto now = Clock::now();
  if (!terminal_ || total_ == 0 || (shown_ && now - last_shown_ < std::chrono::milliseconds(100))) {
    return;
  }
  const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
  std::string line = kEraseLine + label_ + " " + std::to_string(done) + "/" + std::to_string(total_);
  if (done > 0) {
    line += ", " + duration_text(elapsed_s * static_cast<double>(total_ - done) / static_cast<double>(done)) + " left";
  }
  (void)std::fputs(line.c_str(), stderr);
  (void)std::fflush(stderr);
  shown_ = true;
  last_shown_ = now;
}

}  // namespace depthgrid::report
