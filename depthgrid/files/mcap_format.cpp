#include "depthgrid/files/mcap_format.hpp"

#include <zlib.h>

#include "depthgrid/core/error.hpp"

namespace depthgrid::files {

std::uint32_t mcap_crc(std::span<const std::byte> bytes, std::uint32_t so_far) noexcept {
  return static_cast<std::uint32_t>(
      ::crc32_z(so_far, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

std::span<const std::byte> McapContents::bytes(std::uint64_t count, const char* name) {
  if (count > bytes_.size()) {
    fail(context_, ": broken: '", name, "' needs ", count, " bytes, its record has ", bytes_.size(), " left");
  }
  const std::span<const std::byte> taken = bytes_.first(static_cast<std::size_t>(count));
  bytes_ = bytes_.subspan(static_cast<std::size_t>(count));
  return taken;
}

std::string_view McapContents::text(const char* name) {
  const std::span<const std::byte> raw = bytes(number<std::uint32_t>(name), name);
  return {reinterpret_cast<const char*>(raw.data()), raw.size()};
}

McapContents McapContents::list(const char* name) { return {bytes(number<std::uint32_t>(name), name), context_}; }

std::map<std::string, std::string> McapContents::texts(const char* name) {
  std::map<std::string, std::string> found;
  for (McapContents entries = list(name); entries.left() > 0;) {
    std::string key(entries.text(name));
    found[std::move(key)] = entries.text(name);
  }
  return found;
}

McapRecord take_mcap_record(std::span<const std::byte>& bytes, std::string_view context) {
  McapContents head(bytes, context);
  const auto opcode = head.number<std::uint8_t>("opcode");
  const auto length = head.number<std::uint64_t>("length");
  const std::span<const std::byte> contents = head.bytes(length, "record");
  bytes = head.rest();
  return {.opcode = static_cast<McapOpcode>(opcode), .contents = contents};
}

McapBuilder& McapBuilder::text(std::string_view value) {
  number(static_cast<std::uint32_t>(value.size()));
  return raw(std::as_bytes(std::span(value)));
}

McapBuilder& McapBuilder::raw(std::span<const std::byte> value) {
  bytes_.insert(bytes_.end(), value.begin(), value.end());
  return *this;
}

McapBuilder& McapBuilder::texts(const std::map<std::string, std::string>& value) {
  McapBuilder entries;
  for (const auto& [key, text] : value) {
    entries.text(key).text(text);
  }
  number(static_cast<std::uint32_t>(entries.bytes().size()));
  return raw(entries.bytes());
}

void McapBuilder::end_record(McapOpcode opcode, std::vector<std::byte>& to) {
  McapBuilder head;
  head.number(static_cast<std::uint8_t>(opcode)).number(std::uint64_t{bytes_.size()});
  to.insert(to.end(), head.bytes_.begin(), head.bytes_.end());
  to.insert(to.end(), bytes_.begin(), bytes_.end());
  bytes_.clear();
}

}  // namespace depthgrid::files
