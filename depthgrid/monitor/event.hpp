// What happened, for the log: from each thread through a queue of its own.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "depthgrid/monitor/cell_answer.hpp"

namespace depthgrid::monitor {

enum class EventKind : std::uint8_t {
  source_open,       ///< a camera, or the joints, was opened; the text says what it is
  source_failed,     ///< it could not be opened, or was lost; the text says why
  source_ended,      ///< a recording is at its end
  camera_state,      ///< a camera's images are refused, or taken again; the text says why
  stop,              ///< from now on answers say stop: `reason`
  go,                ///< and from now on they do not
  recording_failed,  ///< nothing more is recorded; the text says why
};

struct Event {
  static constexpr std::size_t kLongest = 240;
  static constexpr std::size_t kJoints = static_cast<std::size_t>(-1);  ///< in place of a camera

  double time_s = 0;
  EventKind kind = EventKind::go;
  std::size_t camera = kJoints;
  CameraState state = CameraState::live;
  Reason reason{};
  std::array<char, kLongest> text{};  ///< ends with a 0

  void say(std::string_view words) noexcept {
    const std::size_t size = std::min(words.size(), kLongest - 1);
    std::copy_n(words.begin(), size, text.begin());
    text[size] = '\0';
  }
  [[nodiscard]] std::string_view words() const noexcept { return text.data(); }
};

/// Bounded. One thread writes, one reads; what does not fit is counted. Locks and allocates nothing.
class EventQueue {
 public:
  void push(const Event& event) noexcept {
    if (also_ != nullptr) {
      also_->push(event);
    }
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == kRoom) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    events_[end % kRoom] = event;
    end_.store(end + 1, std::memory_order_release);
  }
  [[nodiscard]] bool pop(Event& event) noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) {
      return false;
    }
    event = events_[begin % kRoom];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }
  /// What is pushed from now on goes into `other`, too, which outlives it. Before there are threads.
  void also(EventQueue& other) noexcept { also_ = &other; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kRoom = 64;
  EventQueue* also_ = nullptr;
  std::array<Event, kRoom> events_{};
  std::atomic<std::size_t> begin_{0};
  std::atomic<std::size_t> end_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace depthgrid::monitor
