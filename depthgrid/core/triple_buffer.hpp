// The newest value from one thread to another, without waiting.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace depthgrid {

/// - Threads: one writes, one reads, at once. Neither waits, locks or allocates.
/// - The reader gets the newest value that was published as a whole; older ones are lost.
template <class Value>
class TripleBuffer {
 public:
  /// Every value begins as `initial`, for instance a vector of its final size.
  explicit TripleBuffer(const Value& initial) : values_{initial, initial, initial} {}

  /// The writer's: what publish() hands over; afterwards another, with old contents.
  [[nodiscard]] Value& back() noexcept { return values_[back_]; }
  void publish() noexcept {
    back_ = between_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }

  /// The reader's: takes what was published last. False when nothing is newer than front().
  bool take() noexcept {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) {
      return false;
    }
    front_ = between_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// What was taken last; the initial value before that.
  [[nodiscard]] const Value& front() const noexcept { return values_[front_]; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  std::array<Value, 3> values_;
  std::uint8_t back_ = 0;                 ///< the writer's
  std::atomic<std::uint8_t> between_{1};  ///< with kFresh when the reader has not had it
  std::uint8_t front_ = 2;                ///< the reader's
};

}  // namespace depthgrid
