#include "depthgrid/messages/cdr_reader.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"

namespace depthgrid::messages {
namespace {

constexpr std::size_t kHeaderBytes = 4;

}  // namespace

CdrReader::CdrReader(std::span<const std::byte> bytes, std::string_view what) : what_(what) {
  if (bytes.size() < kHeaderBytes) {
    fail(what, ": has ", bytes.size(), " bytes, must have at least the ", kHeaderBytes,
         " that say how a message is written");
  }
  const auto first = std::to_integer<unsigned>(bytes[0]);
  const auto second = std::to_integer<unsigned>(bytes[1]);
  if (first != 0 || second > 1) {
    fail(what, ": begins with the bytes ", first, " ", second,
         ", must be 0 0 or 0 1: plain CDR (XCDR1), as ROS 2 writes it");
  }
  swap_ = (second == 1) != (std::endian::native == std::endian::little);
  body_ = bytes.subspan(kHeaderBytes);
}

std::string_view CdrReader::text(std::string_view name) {
  const std::span<const std::byte> raw = take(count(name), name);
  const std::string_view text(reinterpret_cast<const char*>(raw.data()), raw.size());
  return text.ends_with('\0') ? text.substr(0, text.size() - 1) : text;
}

void CdrReader::require_numbers(std::size_t count, std::size_t size, std::string_view name) const {
  const std::size_t left = body_.size() - std::min(at_, body_.size());
  if (count > left / size) {
    fail_at(count * size, name);
  }
}

void CdrReader::align(std::size_t size) noexcept { at_ += (size - at_ % size) % size; }

std::span<const std::byte> CdrReader::take(std::size_t size, std::string_view name) {
  if (at_ > body_.size() || size > body_.size() - at_) {
    fail_at(size, name);
  }
  const std::span<const std::byte> taken = body_.subspan(at_, size);
  at_ += size;
  return taken;
}

void CdrReader::copy(std::span<const std::byte> from, std::span<std::byte> to) const noexcept {
  if (swap_) {
    std::reverse_copy(from.begin(), from.end(), to.begin());
  } else {
    std::copy(from.begin(), from.end(), to.begin());
  }
}

void CdrReader::fail_at(std::size_t needed, std::string_view name) const {
  fail(what_, ": '", name, "' needs ", needed, " bytes at byte ", at_ + kHeaderBytes, ", the message has ",
       body_.size() + kHeaderBytes);
}

}  // namespace depthgrid::messages
