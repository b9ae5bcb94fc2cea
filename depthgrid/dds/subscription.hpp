// The reading end of a topic.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace depthgrid::dds {

/// When a message was sent, by its publisher's clock.
struct Taken {
  bool message = false;  ///< there was one
  double sent_s = 0;     ///< seconds since 1970
};

/// - Threads: one at a time.
/// Must not outlive its node.
class Subscription {
 public:
  ~Subscription();
  Subscription(Subscription&&) noexcept;
  Subscription& operator=(Subscription&&) noexcept;
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  /// The oldest message that waits, in place of what `message` held, whose memory is used again. At most as many wait
  /// as the depth says; of more the oldest are lost.
  [[nodiscard]] Taken take(std::vector<std::byte>& message);
  /// Until one waits, or for so long. Whether one does.
  [[nodiscard]] bool wait(double timeout_s) noexcept;
  /// Publishers that are connected.
  [[nodiscard]] std::size_t publishers() const noexcept;

 private:
  friend class Node;
  struct State;
  explicit Subscription(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::dds
