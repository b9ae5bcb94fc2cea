// The writing end of a topic.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace depthgrid::dds {

/// - Threads: write() from one at a time.
/// Must not outlive its node.
class Publisher {
 public:
  ~Publisher();
  Publisher(Publisher&&) noexcept;
  Publisher& operator=(Publisher&&) noexcept;
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// A message as messages::to_bytes() makes it. False where Cyclone DDS did not take it; it waits for up to 0.1 s
  /// while a reliable subscriber is behind.
  [[nodiscard]] bool write(std::span<const std::byte> message) noexcept;
  /// Subscriptions that are connected.
  [[nodiscard]] std::size_t subscribers() const noexcept;

 private:
  friend class Node;
  struct State;
  explicit Publisher(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::dds
