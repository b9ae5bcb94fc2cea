// Writes recordings of ROS 2 messages as MCAP files, which ROS 2, Foxglove and Rerun read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "depthgrid/messages/message_type.hpp"

namespace depthgrid::files {

/// Of the messages in a file. A depth image of 640 x 480 takes about 2 ms with lz4 and 7 ms with zstd, which makes it
/// smaller by a third.
enum class McapCompression : std::uint8_t { none, lz4, zstd };

struct McapWriterOptions {
  McapCompression compression = McapCompression::zstd;
  /// Messages are collected up to this size and then written: what a program loses that dies. From 1 to 2^26.
  std::size_t chunk_bytes = std::size_t{1} << 22U;
  /// What is there already is refused, not replaced.
  bool only_new = false;
};

/// Messages are written in the order in which they come, with indexes and CRCs, profile "ros2". The file has its name
/// from the beginning: what was written is readable up to its last whole chunk, whatever happens to the program. Not
/// thread-safe.
class McapWriter {
 public:
  /// Replaces the file, unless options say otherwise. Throws Error that names it and the reason.
  explicit McapWriter(const std::filesystem::path& file, const McapWriterOptions& options = {});
  /// Without close() the file has no summary; then reading has to look at all of it.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// A topic and the type of its messages. `keeps_last`: who plays the file back hands the last message to those who
  /// come later (transient local), as for /tf_static. Throws Error for an empty topic, one that is there, and more than
  /// 65535.
  std::uint16_t add_channel(std::string_view topic, const messages::MessageType& type, bool keeps_last = false);

  /// Times are nanoseconds on the clock of the recording: when the message came, and when it was sent. Throws Error for
  /// a channel that was not added, and when the disk is full.
  void write(std::uint16_t channel, std::uint64_t log_time_ns, std::uint64_t publish_time_ns,
             std::span<const std::byte> message);

  /// Texts by names, apart from the messages, at this place of the file. Throws Error.
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& texts);

  /// What was collected goes to the file. Throws Error.
  void flush();

  /// Writes the summary. Nothing can be written afterwards. Throws Error.
  void close();

 private:
  class File;
  std::unique_ptr<File> file_;
};

}  // namespace depthgrid::files
