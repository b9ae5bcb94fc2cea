#include "depthgrid/files/mcap_bytes.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/mcap_compression.hpp"
#include "depthgrid/files/mcap_format.hpp"

namespace depthgrid::files {
namespace {

/// Chunks kept decompressed: images of one instant lie in neighbouring ones.
constexpr std::size_t kChunksKept = 3;

}  // namespace

McapBytes::McapBytes(const std::filesystem::path& file) : name_(file.string()), stream_(open_regular_file(file)) {
  if (::fseeko(stream_.get(), 0, SEEK_END) != 0) {
    fail(name_, ": cannot be read: its size is not known");
  }
  size_ = static_cast<std::uint64_t>(::ftello(stream_.get()));
  check_magic();
}

void McapBytes::read_at(std::uint64_t position, std::uint64_t count, std::vector<std::byte>& bytes) {
  bytes.resize(static_cast<std::size_t>(count));
  if (::fseeko(stream_.get(), static_cast<off_t>(position), SEEK_SET) != 0 ||
      std::fread(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) {
    fail(name_, ": cannot be read: ", count, " bytes at byte ", position);
  }
}

McapHead McapBytes::head_at(std::uint64_t position) {
  if (position > size_ || size_ - position < kMcapRecordHead) {
    fail(name_, ": the index is broken: byte ", position, " of ", size_, " holds no record");
  }
  read_at(position, kMcapRecordHead, head_);
  McapContents head(head_, name_);
  McapHead found;
  found.opcode = head.number<std::uint8_t>("opcode");
  found.length = head.number<std::uint64_t>("length");
  return found;
}

bool McapBytes::fits(std::uint64_t position, const McapHead& head) const noexcept {
  return head.length <= size_ - position - kMcapRecordHead;
}

std::uint64_t McapBytes::checked_length(std::uint64_t position, const McapHead& head) const {
  if (!fits(position, head)) {
    fail(name_, ": broken: the record at byte ", position, " has ", head.length, " bytes, the file ends before");
  }
  if (head.length > kLargestMcapChunk) {
    fail(name_, ": the record at byte ", position, " has ", head.length, " bytes, must have at most ",
         kLargestMcapChunk);
  }
  return head.length;
}

void McapBytes::check_magic() {
  std::vector<std::byte> begin;
  read_at(0, std::min<std::uint64_t>(size_, kMcapMagic.size()), begin);
  const auto begins_with = [&](std::span<const std::uint8_t> bytes) {
    return begin.size() >= bytes.size() && std::equal(bytes.begin(), bytes.end(), begin.begin(),
                                                      [](std::uint8_t a, std::byte b) { return std::byte{a} == b; });
  };
  constexpr std::array<std::uint8_t, 4> kZstd{0x28, 0xB5, 0x2F, 0xFD};
  if (begins_with(kZstd)) {
    fail(name_, ": is a file compressed as a whole with zstd; decompress it first: unzstd ", name_);
  }
  if (!begins_with(kMcapMagic)) {
    fail(name_,
         ": is no MCAP file: ", begin.empty() ? "it is empty" : "its first bytes are not those of MCAP, version 0");
  }
}

const std::vector<std::byte>& McapBytes::chunk_at(std::uint64_t position) {
  const auto kept =
      std::find_if(kept_.begin(), kept_.end(), [position](const Chunk& chunk) { return chunk.position == position; });
  if (kept != kept_.end()) {
    std::rotate(kept, kept + 1, kept_.end());  // the newest is last
    return kept_.back().records;
  }
  const McapHead head = head_at(position);
  const std::string where = name_ + ": chunk at byte " + std::to_string(position);
  if (head.opcode != static_cast<std::uint8_t>(McapOpcode::chunk)) {
    fail(name_, ": the index is broken: there is no chunk at byte ", position);
  }
  read_at(position + kMcapRecordHead, checked_length(position, head), raw_chunk_);
  McapContents in(raw_chunk_, where);
  static_cast<void>(in.bytes(2 * sizeof(std::uint64_t), "times"));
  const auto size = in.number<std::uint64_t>("uncompressed_size");
  const auto crc = in.number<std::uint32_t>("uncompressed_crc");
  const std::string_view compression = in.text("compression");
  const std::span<const std::byte> data = in.bytes(in.number<std::uint64_t>("records"), "records");
  if (size > kLargestMcapChunk) {
    fail(where, ": has ", size, " bytes decompressed, must have at most ", kLargestMcapChunk);
  }
  Chunk chunk;
  if (kept_.size() == kChunksKept) {
    chunk = std::move(kept_.front());  // its memory is used again
    kept_.erase(kept_.begin());
  }
  chunk.position = position;
  mcap_decompress(compression, data, static_cast<std::size_t>(size), chunk.records, where);
  if (crc != 0 && mcap_crc(chunk.records) != crc) {
    fail(where, ": its CRC is wrong: the file is damaged");
  }
  kept_.push_back(std::move(chunk));
  return kept_.back().records;
}

}  // namespace depthgrid::files
