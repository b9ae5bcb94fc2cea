#include "depthgrid/messages/cdr_writer.hpp"

#include <limits>

#include "depthgrid/core/error.hpp"

namespace depthgrid::messages {
namespace {

constexpr std::array<std::byte, 4> kLittleEndian{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};

}  // namespace

CdrWriter::CdrWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {
  bytes_.clear();
  append(kLittleEndian);
}

void CdrWriter::text(std::string_view value) {
  count(value.size() + 1);
  append(std::as_bytes(std::span(value)));
  bytes_.push_back(std::byte{0});
}

void CdrWriter::count(std::size_t size) {
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    fail("a message cannot hold a list or text of ", size, " elements, must be below 2^32");
  }
  number(static_cast<std::uint32_t>(size));
}

void CdrWriter::bytes(std::span<const std::byte> value) {
  count(value.size());
  append(value);
}

void CdrWriter::align(std::size_t size) {
  const std::size_t at = bytes_.size() - kLittleEndian.size();
  bytes_.resize(bytes_.size() + (size - at % size) % size);
}

void CdrWriter::append(std::span<const std::byte> value) { bytes_.insert(bytes_.end(), value.begin(), value.end()); }

}  // namespace depthgrid::messages
