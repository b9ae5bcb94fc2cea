// Buffers of which readers hold some while one is written: how many there are, which is free, and how to hold the
// newest. What makes it sound stands in view_store.cpp. Templates, so that a test can put its own atomics in and choose
// the order of all steps. Internal.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "depthgrid/core/error.hpp"

namespace depthgrid::views {

/// Most different snapshots that may be held at once.
inline constexpr int kMaxHeld = 13;
/// Buffers besides those that held snapshots pin: the newest, and the one that is written next.
inline constexpr int kSpareSlots = 2;
inline constexpr std::size_t kMaxSlots = kMaxHeld + kSpareSlots;

/// How many snapshots hold each buffer.
using SlotReferences = std::array<std::atomic<std::uint32_t>, kMaxSlots>;

/// Throws Error unless 1 to kMaxHeld snapshots may be held; gives how many buffers that takes.
[[nodiscard]] inline std::size_t slots_for(int held_snapshots, const char* name) {
  if (held_snapshots < 1 || held_snapshots > kMaxHeld) {
    fail(name, ": held_snapshots is ", held_snapshots, ", must be between 1 and ", kMaxHeld);
  }
  return static_cast<std::size_t>(held_snapshots) + kSpareSlots;
}

/// Of the first `count` buffers one that nobody reads and that is not the newest; `count` when there is none. Threads
/// in the middle of a snapshot() occupy one for an instant, so it looks more than once.
template <class References>
[[nodiscard]] std::size_t free_slot(const References& references, std::size_t count, std::size_t newest) noexcept {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    for (std::size_t slot = 0; slot < count; ++slot) {
      if (slot != newest && references[slot].load() == 0) {
        return slot;
      }
    }
  }
  return count;
}

/// The index of every camera's newest buffer, four bits a camera.
[[nodiscard]] constexpr std::size_t slot_of(std::uint64_t slots, std::size_t camera) noexcept {
  return static_cast<std::size_t>(slots >> (4 * camera)) & 15U;
}

[[nodiscard]] constexpr std::uint64_t with_slot(std::uint64_t slots, std::size_t camera, std::size_t slot) noexcept {
  return (slots & ~(std::uint64_t{15} << (4 * camera))) | (std::uint64_t{slot} << (4 * camera));
}

/// A writer's last step: its camera's buffer becomes the newest, those of the other cameras stay what they are.
template <class Newest>
void make_newest(Newest& newest, std::size_t camera, std::size_t slot) noexcept {
  std::uint64_t slots = newest.load();
  while (!newest.compare_exchange_weak(slots, with_slot(slots, camera, slot))) {
  }
}

/// A reader's first steps: what `newest` named at one instant, with all of that held. hold() and release() count a
/// reader of every buffer that a word names more or less.
template <class Newest, class Hold, class Release>
[[nodiscard]] auto hold_newest(const Newest& newest, Hold&& hold, Release&& release) noexcept {
  while (true) {
    const auto slots = newest.load();
    hold(slots);
    if (newest.load() == slots) {
      return slots;
    }
    release(slots);
  }
}

}  // namespace depthgrid::views
