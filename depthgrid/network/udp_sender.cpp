#include "depthgrid/network/udp_sender.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "depthgrid/core/error.hpp"

namespace depthgrid::network {
namespace {

std::string reason() { return std::generic_category().message(errno); }

}  // namespace

UdpSender::UdpSender(const std::string& host, int port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  if (port < 1 || port > 65535) {
    fail("udp: port ", port, " must be from 1 to 65535");
  }
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::inet_pton(AF_INET, host.c_str(), &to.sin_addr) != 1) {
    fail("udp: host '", host, "' is no address, must be four numbers such as 127.0.0.1");
  }
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) {
    fail("udp: no socket: ", reason());
  }
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    const std::string why = reason();
    (void)::close(socket_);
    fail("udp: ", host, " port ", port, ": ", why);
  }
}

UdpSender::~UdpSender() { (void)::close(socket_); }

bool UdpSender::send(std::span<const unsigned char> datagram) noexcept {
  const ssize_t count = ::send(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  const bool taken = count == static_cast<ssize_t>(datagram.size());
  ++(taken ? sent_ : lost_);
  return taken;
}

}  // namespace depthgrid::network
