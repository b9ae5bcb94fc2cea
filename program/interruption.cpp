#include "program/interruption.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <ctime>

#include "depthgrid/core/file_replacement.hpp"

namespace depthgrid::program {
namespace {

constexpr std::size_t kLongestLine = 160;

/// A signal and its line, made before it comes: a handler may not make texts.
struct Interruption {
  int signal = 0;
  const char* name = nullptr;
  std::array<char, kLongestLine> line{};
  std::size_t line_bytes = 0;
};
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler gets nothing handed over
std::array<Interruption, 3> interruptions{{{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}};

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): the same
std::atomic<int> signals_left{0};  ///< before one ends the process

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): the same
std::atomic<std::int64_t> first_ns{0};  ///< when one asked for the end

/// Async-signal-safe.
std::int64_t now_ns() noexcept {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  timespec now{};
  (void)::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * kSecond_ns + now.tv_nsec;
}

/// Only async-signal-safe functions: unlink, write, _exit.
extern "C" void end_on_signal(int signal) {
  // timeout, for one, sends it to the process and to its group: that is one wish.
  constexpr std::int64_t kOneWish_ns = 300'000'000;
  if (signals_left.load() > 1) {
    first_ns.store(now_ns());
    signals_left.store(1);
    return;
  }
  if (signals_left.load() == 1 && now_ns() - first_ns.load() < kOneWish_ns) {
    return;
  }
  remove_unfinished_files();
  for (const Interruption& interruption : interruptions) {
    if (interruption.signal == signal) {
      const ssize_t written = ::write(STDERR_FILENO, interruption.line.data(), interruption.line_bytes);
      static_cast<void>(written);
    }
  }
  ::_exit(128 + signal);
}

}  // namespace

void ask_before_the_end() {
  signals_left.store(2);
  // Somebody who stops reading what is printed does not end the rest.
  (void)::signal(SIGPIPE, SIG_IGN);
}

bool stop_is_asked() noexcept { return signals_left.load() == 1; }

void end_tidily_on_signals(const std::string& program_name) {
  const std::string erased = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";  // the progress line
  struct sigaction action {};
  action.sa_handler = end_on_signal;
  ::sigemptyset(&action.sa_mask);
  for (const Interruption& interruption : interruptions) {
    ::sigaddset(&action.sa_mask, interruption.signal);
  }
  for (Interruption& interruption : interruptions) {
    const std::string line =
        erased + program_name + ": stopped by " + interruption.name + "; unfinished output was removed\n";
    interruption.line_bytes = std::min(line.size(), kLongestLine);
    std::copy_n(line.begin(), interruption.line_bytes, interruption.line.begin());
    struct sigaction before {};
    if (::sigaction(interruption.signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
      static_cast<void>(::sigaction(interruption.signal, &action, nullptr));
    }
  }
}

}  // namespace depthgrid::program
