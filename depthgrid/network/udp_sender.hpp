// Datagrams to one address.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace depthgrid::network {

/// - Threads: one.
/// - Errors: the constructor throws Error. Datagrams that the system does not take are counted, nothing waits.
class UdpSender {
 public:
  /// host: an address of IPv4 as numbers, "127.0.0.1". Throws Error.
  UdpSender(const std::string& host, int port);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// False: not taken.
  bool send(std::span<const unsigned char> datagram) noexcept;

  [[nodiscard]] std::int64_t sent() const noexcept { return sent_; }
  /// Nobody listens there, the network is down, or its queue is full.
  [[nodiscard]] std::int64_t lost() const noexcept { return lost_; }

 private:
  int socket_ = -1;
  std::int64_t sent_ = 0;
  std::int64_t lost_ = 0;
};

}  // namespace depthgrid::network
