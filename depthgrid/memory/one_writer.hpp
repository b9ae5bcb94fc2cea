// Who writes the memory: one thread at a time, and nobody waits. A template, so that a test can put its own atomics in
// and choose the order of all steps. Internal.
#pragma once

#include <cstddef>
#include <cstdint>

#include "depthgrid/views/held_slots.hpp"

namespace depthgrid::memory {

/// Whoever finds nobody writing writes. Who finds somebody leaves a bit a camera for him and goes. A writer that has
/// let go looks once more for bits, and a bit that is left after that look finds nobody writing: no image is forgotten,
/// unless the writer has had its rounds, and then the next image brings it along.
/// - Threads: all from any threads at once. Nobody waits, locks or allocates.
template <class Flag, class Word>
class OneWriter {
 public:
  /// Leaves a camera's bit. False: one was there already, and its image is replaced by the newer one.
  [[nodiscard]] bool leave(std::uint32_t bit) noexcept { return (waiting_.fetch_or(bit) & bit) == 0; }

  /// look(cameras) at all that wait, unless somebody else writes, who looks at them then.
  template <class Look>
  void look_at_waiting(Look&& look) noexcept {
    for (int round = 0; round < kRounds && waiting_.load() != 0; ++round) {
      if (busy_.exchange(true)) {
        return;
      }
      const std::uint32_t cameras = waiting_.exchange(0);
      if (cameras != 0) {
        look(cameras);
      }
      busy_.store(false);
    }
  }

  /// Calls write() unless somebody else writes; false then. Then look(cameras) at those that waited meanwhile.
  template <class Write, class Look>
  [[nodiscard]] bool try_write(Write&& write, Look&& look) noexcept {
    if (busy_.exchange(true)) {
      return false;
    }
    write();
    busy_.store(false);
    look_at_waiting(look);
    return true;
  }

 private:
  /// How often a thread looks for images that came meanwhile. What is left waits for the next.
  static constexpr int kRounds = 2;

  Flag busy_{false};
  Word waiting_{0};  ///< cameras, a bit each
};

/// For the writer: fill(before, slot) makes a buffer from the newest one, and then it is the newest. Of `count` buffers
/// it is one that nobody reads; false where there is none.
template <class Newest, class References, class Fill>
[[nodiscard]] bool write_newest(Newest& newest, const References& references, std::size_t count, Fill&& fill) noexcept {
  const std::size_t before = newest.load();
  const std::size_t slot = views::free_slot(references, count, before);
  if (slot == count) {
    return false;
  }
  fill(before, slot);
  newest.store(static_cast<std::uint32_t>(slot));
  return true;
}

}  // namespace depthgrid::memory
