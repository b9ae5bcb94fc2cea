// Reads MCAP files of anybody, by their index, or from the beginning where that is missing or broken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::files {

/// A topic in a file and what its messages are. Texts are as they stand in the file.
struct McapChannel {
  std::uint16_t id = 0;
  std::string topic;
  std::string encoding;         ///< of messages: "cdr"
  std::string type;             ///< "sensor_msgs/msg/Image"; empty: the file does not say
  std::string schema_encoding;  ///< of the definition: "ros2msg"
  std::string definition;
  std::map<std::string, std::string> metadata;
};

/// Where a message is, and when it was recorded.
struct McapEntry {
  std::uint64_t log_time_ns = 0;
  std::uint64_t position = 0;  ///< in the file: of the chunk that it is in, or its own
  std::uint64_t offset = 0;    ///< in the chunk, decompressed
  std::uint16_t channel = 0;
  bool in_chunk = false;
};

/// One message. `data` is a view, valid until the next read.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  std::span<const std::byte> data;
};

/// Most messages that entries() lists.
inline constexpr std::size_t kMostMcapMessages = std::size_t{1} << 24U;

/// A file whose end is missing is read up to its last whole record. Records that are not known are passed over.
/// Whatever the file says, no more memory is taken than for some chunks (256 MiB each at most) and lists of what is in
/// it. Not thread-safe.
class McapReader {
 public:
  /// Throws Error that names the file and the reason: absent, no MCAP file, broken before its end, a chunk that is too
  /// large or compressed in an unknown way.
  explicit McapReader(const std::filesystem::path& file);
  ~McapReader();
  McapReader(McapReader&&) noexcept;
  McapReader& operator=(McapReader&&) noexcept;
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  /// In the order of their ids.
  [[nodiscard]] std::span<const McapChannel> channels() const noexcept;
  /// Null where there is no such topic.
  [[nodiscard]] const McapChannel* channel(std::string_view topic) const noexcept;
  /// All channels of this one's topic, type and encoding: a recorder that begins anew makes another for the same topic.
  [[nodiscard]] std::vector<std::uint16_t> same_as(const McapChannel& channel) const;
  /// What the file calls itself: "ros2".
  [[nodiscard]] const std::string& profile() const noexcept;
  /// Texts that stand apart from messages, by the names of their records; of records of one name the first. Those of
  /// more than 2 MiB are passed over.
  [[nodiscard]] const std::map<std::string, std::map<std::string, std::string>>& metadata() const noexcept;
  /// In words what is missing at the end or why the summary is not used; empty: nothing.
  [[nodiscard]] const std::string& damage() const noexcept;

  /// The messages of these channels, in the order of the file. Throws Error where an index or a chunk is broken, and
  /// for more than kMostMcapMessages.
  [[nodiscard]] std::vector<McapEntry> entries(std::span<const std::uint16_t> channels);
  [[nodiscard]] std::vector<McapEntry> entries(std::uint16_t channel) { return entries(std::span(&channel, 1)); }

  /// Throws Error where the chunk is broken (its CRC is checked) or the message is not there.
  [[nodiscard]] McapMessage read(const McapEntry& entry);

 private:
  class File;
  std::unique_ptr<File> file_;
};

}  // namespace depthgrid::files
