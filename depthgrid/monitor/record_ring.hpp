// What waits to be recorded: bounded, one thread writes, one reads, neither waits for the other. Internal.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace depthgrid::monitor {

/// Locks nothing; allocates where T does when a slot is filled.
template <class T>
class RecordRing {
 public:
  /// `slot`: of the final size, so that filling one need not allocate.
  RecordRing(std::size_t room, const T& slot) : slots_(room, slot) {}

  /// To be filled, then published. Null: there is no room, which is counted.
  [[nodiscard]] T* back() noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == slots_.size()) {
      drop();
      return nullptr;
    }
    return &slots_[end % slots_.size()];
  }
  void publish() noexcept { end_.store(end_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }
  void drop() noexcept { dropped_.fetch_add(1, std::memory_order_relaxed); }

  /// The oldest; null: there is none.
  [[nodiscard]] const T* front() const noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    return begin == end_.load(std::memory_order_acquire) ? nullptr : &slots_[begin % slots_.size()];
  }
  void pop() noexcept { begin_.store(begin_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// For who reads.
  [[nodiscard]] std::size_t size() const noexcept {
    return end_.load(std::memory_order_acquire) - begin_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::vector<T> slots_;
  std::atomic<std::size_t> begin_{0};
  std::atomic<std::size_t> end_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace depthgrid::monitor
