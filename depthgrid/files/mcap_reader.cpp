#include "depthgrid/files/mcap_reader.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/mcap_bytes.hpp"
#include "depthgrid/files/mcap_format.hpp"

namespace depthgrid::files {
namespace {

/// A summary is held in memory: of larger ones the file is read from its beginning.
constexpr std::uint64_t kLargestSummary = std::uint64_t{1} << 26U;
constexpr std::uint64_t kLargestMetadata = std::uint64_t{1} << 21U;
constexpr std::size_t kMostMetadata = 100;

struct Schema {
  std::string name;
  std::string encoding;
  std::string definition;
};

struct Channel {
  std::uint16_t schema = 0;
  McapChannel described;
};

/// A chunk in the file, and where the index says that its messages are listed.
struct ChunkPlace {
  std::uint64_t position = 0;
  std::map<std::uint16_t, std::uint64_t> index_of;  ///< by channel; empty: it has to be looked through
};

}  // namespace

class McapReader::File {
 public:
  using Metadata = std::map<std::string, std::map<std::string, std::string>>;

  explicit File(const std::filesystem::path& file) : bytes_(file), name_(bytes_.name()), size_(bytes_.size()) {
    if (!read_summary()) {
      scan();
    }
    describe_channels();
  }

  [[nodiscard]] std::vector<McapEntry> entries(std::span<const std::uint16_t> asked) {
    const std::set<std::uint16_t> wanted(asked.begin(), asked.end());
    if (by_index_) {
      try {
        return listed_by_index(wanted);
      } catch (const Error& error) {
        note(std::string("its index is not used: ") + error.what());
      }
      by_index_ = false;
      scan();
    }
    return listed(wanted);
  }

  [[nodiscard]] McapMessage read(const McapEntry& entry) {
    const std::string where = name_ + ": message at byte " + std::to_string(entry.position) +
                              (entry.in_chunk ? " + " + std::to_string(entry.offset) : std::string());
    std::span<const std::byte> bytes;
    if (entry.in_chunk) {
      const std::vector<std::byte>& records = bytes_.chunk_at(entry.position);
      if (entry.offset > records.size()) {
        fail(where, ": the index is broken: the chunk has ", records.size(), " bytes");
      }
      bytes = std::span<const std::byte>(records).subspan(static_cast<std::size_t>(entry.offset));
    } else {
      const McapHead head = bytes_.head_at(entry.position);
      bytes_.read_at(entry.position, kMcapRecordHead + bytes_.checked_length(entry.position, head), record_);
      bytes = record_;
    }
    const McapRecord record = take_mcap_record(bytes, where);
    if (record.opcode != McapOpcode::message) {
      fail(where, ": the index is broken: there is a record ", static_cast<int>(record.opcode), ", no message");
    }
    McapContents contents(record.contents, where);
    McapMessage message;
    message.channel = contents.number<std::uint16_t>("channel");
    message.sequence = contents.number<std::uint32_t>("sequence");
    message.log_time_ns = contents.number<std::uint64_t>("log_time");
    message.publish_time_ns = contents.number<std::uint64_t>("publish_time");
    message.data = contents.rest();
    if (message.channel != entry.channel || message.log_time_ns != entry.log_time_ns) {
      fail(where, ": the index is broken: there is a message of channel ", message.channel, " and time ",
           message.log_time_ns, " ns, not of channel ", entry.channel, " and time ", entry.log_time_ns, " ns");
    }
    return message;
  }

  [[nodiscard]] std::span<const McapChannel> channels() const noexcept { return channels_; }
  [[nodiscard]] const std::string& profile() const noexcept { return profile_; }
  [[nodiscard]] const std::string& damage() const noexcept { return damage_; }
  [[nodiscard]] const Metadata& metadata() const noexcept { return metadata_; }

 private:
  void note(const std::string& words) { damage_ += (damage_.empty() ? "" : "; ") + words; }

  // What is in it.

  void add_schema(std::span<const std::byte> contents) {
    McapContents in(contents, name_);
    const auto id = in.number<std::uint16_t>("schema");
    Schema schema;
    schema.name = in.text("name");
    schema.encoding = in.text("encoding");
    const std::span<const std::byte> data = in.bytes(in.number<std::uint32_t>("data"), "data");
    schema.definition.assign(reinterpret_cast<const char*>(data.data()), data.size());
    schemas_.try_emplace(id, std::move(schema));
  }

  void add_channel(std::span<const std::byte> contents) {
    McapContents in(contents, name_);
    Channel channel;
    channel.described.id = in.number<std::uint16_t>("channel");
    channel.schema = in.number<std::uint16_t>("schema");
    channel.described.topic = in.text("topic");
    channel.described.encoding = in.text("message_encoding");
    channel.described.metadata = in.texts("metadata");
    const std::string topic = channel.described.topic;
    const auto [place, is_new] = by_id_.try_emplace(channel.described.id, std::move(channel));
    if (!is_new && place->second.described.topic != topic) {
      fail(name_, ": broken: channel ", place->first, " is '", printable_excerpt(place->second.described.topic),
           "' in one place and '", printable_excerpt(topic), "' in another");
    }
  }

  void describe_channels() {
    for (auto& [id, channel] : by_id_) {
      if (const auto schema = schemas_.find(channel.schema); schema != schemas_.end()) {
        channel.described.type = schema->second.name;
        channel.described.schema_encoding = schema->second.encoding;
        channel.described.definition = schema->second.definition;
      }
      channels_.push_back(channel.described);
    }
  }

  void add_header(std::span<const std::byte> contents) {
    McapContents in(contents, name_);
    profile_ = in.text("profile");
  }

  /// The record whose head is known. Throws Error where it is broken.
  void add_metadata(std::uint64_t at, const McapHead& head) {
    if (head.length > kLargestMetadata || metadata_.size() >= kMostMetadata) {
      return;
    }
    bytes_.read_at(at + kMcapRecordHead, bytes_.checked_length(at, head), record_);
    McapContents in(record_, name_);
    std::string name(in.text("name"));
    metadata_.try_emplace(std::move(name), in.texts("metadata"));
  }

  // By the summary.

  /// False where there is none that can be used; then nothing is known yet.
  bool read_summary() {
    try {
      if (use_summary()) {
        by_index_ = true;
        return true;
      }
    } catch (const Error& error) {
      note(std::string("its summary is not used: ") + error.what());
    }
    by_id_.clear();
    schemas_.clear();
    chunks_.clear();
    counts_.clear();
    metadata_.clear();
    has_counts_ = false;
    profile_.clear();
    return false;
  }

  /// Throws where it is broken.
  bool use_summary() {
    const std::uint64_t tail = kMcapRecordHead + kMcapFooterBytes + kMcapMagic.size();
    if (size_ < kMcapMagic.size() + tail) {
      return false;
    }
    const std::uint64_t footer_at = size_ - tail;
    std::vector<std::byte> end;
    bytes_.read_at(footer_at, tail, end);
    has_end_ =
        std::equal(kMcapMagic.begin(), kMcapMagic.end(), end.end() - static_cast<std::ptrdiff_t>(kMcapMagic.size()),
                   [](std::uint8_t a, std::byte b) { return std::byte{a} == b; });
    if (!has_end_) {
      return false;  // the file is cut, and scan() says where
    }
    std::span<const std::byte> rest(end);
    const McapRecord footer = take_mcap_record(rest, name_);
    if (footer.opcode != McapOpcode::footer || footer.contents.size() != kMcapFooterBytes) {
      return false;  // a footer of a later version
    }
    McapContents in(footer.contents, name_);
    const auto start = in.number<std::uint64_t>("summary_start");
    static_cast<void>(in.number<std::uint64_t>("summary_offset_start"));
    const auto crc = in.number<std::uint32_t>("summary_crc");
    if (start == 0) {
      return false;
    }
    if (start > footer_at || footer_at - start > kLargestSummary) {
      fail("it begins at byte ", start, " of ", footer_at);
    }
    std::vector<std::byte> summary;
    bytes_.read_at(start, footer_at - start + kMcapRecordHead + kMcapFooterBytes - sizeof(crc), summary);
    if (crc != 0 && mcap_crc(summary) != crc) {
      fail("its CRC is wrong");
    }
    return take_summary(std::span<const std::byte>(summary).first(static_cast<std::size_t>(footer_at - start)));
  }

  /// Whether it says enough.
  bool take_summary(std::span<const std::byte> records) {
    while (!records.empty()) {
      const McapRecord record = take_mcap_record(records, "a record of it");
      switch (record.opcode) {
        case McapOpcode::schema:
          add_schema(record.contents);
          break;
        case McapOpcode::channel:
          add_channel(record.contents);
          break;
        case McapOpcode::chunk_index:
          add_chunk_index(record.contents);
          break;
        case McapOpcode::statistics:
          add_statistics(record.contents);
          break;
        case McapOpcode::metadata_index:
          add_metadata_at(record.contents);
          break;
        default:
          break;
      }
    }
    const McapHead head = bytes_.head_at(kMcapMagic.size());
    if (head.opcode == static_cast<std::uint8_t>(McapOpcode::header)) {
      std::vector<std::byte> header;
      bytes_.read_at(kMcapMagic.size() + kMcapRecordHead, bytes_.checked_length(kMcapMagic.size(), head), header);
      add_header(header);
    }
    for (const ChunkPlace& chunk : chunks_) {
      for (const auto& [channel, position] : chunk.index_of) {
        if (!by_id_.contains(channel)) {
          return false;
        }
      }
      if (chunk.index_of.empty()) {
        return false;
      }
    }
    // Without statistics nobody knows of messages outside of chunks; without an index nobody finds those in chunks.
    const bool has_messages =
        std::any_of(counts_.begin(), counts_.end(), [](const auto& count) { return count.second > 0; });
    return has_counts_ && (!has_messages || !chunks_.empty());
  }

  void add_chunk_index(std::span<const std::byte> contents) {
    McapContents in(contents, "a chunk index");
    static_cast<void>(in.number<std::uint64_t>("message_start_time"));
    static_cast<void>(in.number<std::uint64_t>("message_end_time"));
    ChunkPlace place;
    place.position = in.number<std::uint64_t>("chunk_start_offset");
    static_cast<void>(in.number<std::uint64_t>("chunk_length"));
    for (McapContents offsets = in.list("message_index_offsets"); offsets.left() > 0;) {
      const auto channel = offsets.number<std::uint16_t>("channel");
      place.index_of[channel] = offsets.number<std::uint64_t>("offset");
    }
    chunks_.push_back(std::move(place));
  }

  void add_metadata_at(std::span<const std::byte> contents) {
    McapContents in(contents, "a metadata index");
    const auto at = in.number<std::uint64_t>("offset");
    const McapHead head = bytes_.head_at(at);
    if (head.opcode != static_cast<std::uint8_t>(McapOpcode::metadata)) {
      fail("there are no metadata at byte ", at);
    }
    add_metadata(at, head);
  }

  void add_statistics(std::span<const std::byte> contents) {
    McapContents in(contents, "the statistics");
    static_cast<void>(in.bytes(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8, "counts"));
    for (McapContents counts = in.list("channel_message_counts"); counts.left() > 0;) {
      const auto channel = counts.number<std::uint16_t>("channel");
      counts_[channel] = counts.number<std::uint64_t>("count");
    }
    has_counts_ = true;
  }

  // From the beginning.

  /// All records up to the end, or to where the file is cut.
  void scan() {
    metadata_.clear();
    chunks_.clear();
    loose_.clear();
    std::uint64_t at = kMcapMagic.size();
    for (;;) {
      if (size_ - at < kMcapRecordHead) {
        note("it is cut: it ends at byte " + std::to_string(size_) + " without the mark of its end");
        return;
      }
      const McapHead head = bytes_.head_at(at);
      if (head.opcode == 0 || !bytes_.fits(at, head)) {
        note("it is cut: it ends at byte " + std::to_string(size_) + " within the record at byte " +
             std::to_string(at) + "; what is before it is read");
        return;
      }
      if (!scan_record(at, head)) {
        if (!has_end_) {
          note("it is cut: it ends at byte " + std::to_string(size_) +
               " within its summary; its messages are all there");
        }
        return;
      }
      at += kMcapRecordHead + head.length;
    }
  }

  /// False at the end of the data.
  bool scan_record(std::uint64_t at, const McapHead& head) {
    switch (static_cast<McapOpcode>(head.opcode)) {
      case McapOpcode::header:
      case McapOpcode::schema:
      case McapOpcode::channel: {
        bytes_.read_at(at + kMcapRecordHead, bytes_.checked_length(at, head), record_);
        take_description({.opcode = static_cast<McapOpcode>(head.opcode), .contents = record_});
        return true;
      }
      case McapOpcode::message:
        if (head.length >= kMcapMessageHead) {
          loose_.push_back(at);
        }
        return true;
      case McapOpcode::chunk: {
        std::span<const std::byte> records = bytes_.chunk_at(at);
        while (!records.empty()) {
          take_description(take_mcap_record(records, name_ + ": chunk at byte " + std::to_string(at)));
        }
        chunks_.push_back({.position = at, .index_of = {}});
        return true;
      }
      case McapOpcode::metadata:
        add_metadata(at, head);
        return true;
      case McapOpcode::data_end:
      case McapOpcode::footer:
        return false;
      default:
        return true;
    }
  }

  void take_description(const McapRecord& record) {
    if (record.opcode == McapOpcode::header) {
      add_header(record.contents);
    } else if (record.opcode == McapOpcode::schema) {
      add_schema(record.contents);
    } else if (record.opcode == McapOpcode::channel) {
      add_channel(record.contents);
    }
  }

  // Messages.

  /// Throws where the index is broken, or does not list as many as the statistics count.
  [[nodiscard]] std::vector<McapEntry> listed_by_index(const std::set<std::uint16_t>& wanted) {
    std::vector<McapEntry> found = listed(wanted);
    std::uint64_t counted = 0;
    for (const std::uint16_t channel : wanted) {
      const auto count = counts_.find(channel);
      counted += count == counts_.end() ? 0 : count->second;
    }
    if (found.size() != counted) {
      fail("it lists ", found.size(), " messages, the statistics count ", counted);
    }
    return found;
  }

  [[nodiscard]] std::vector<McapEntry> listed(const std::set<std::uint16_t>& wanted) {
    std::vector<McapEntry> found;
    for (const ChunkPlace& chunk : chunks_) {
      if (chunk.index_of.empty()) {
        look_through(chunk.position, wanted, found);
      } else {
        take_index(chunk, wanted, found);
      }
      if (found.size() > kMostMcapMessages) {
        fail(name_, ": has more than ", kMostMcapMessages, " messages of the topics asked for; cut it into parts");
      }
    }
    for (const std::uint64_t position : loose_) {
      bytes_.read_at(position + kMcapRecordHead, kMcapMessageHead, record_);
      add_entry({.position = position}, record_, wanted, found);
    }
    return found;
  }

  void add_entry(McapEntry entry, std::span<const std::byte> contents, const std::set<std::uint16_t>& wanted,
                 std::vector<McapEntry>& found) const {
    McapContents in(contents, name_);
    entry.channel = in.number<std::uint16_t>("channel");
    static_cast<void>(in.number<std::uint32_t>("sequence"));
    entry.log_time_ns = in.number<std::uint64_t>("log_time");
    if (wanted.contains(entry.channel)) {
      found.push_back(entry);
    }
  }

  void look_through(std::uint64_t position, const std::set<std::uint16_t>& wanted, std::vector<McapEntry>& found) {
    const std::vector<std::byte>& records = bytes_.chunk_at(position);
    for (std::span<const std::byte> rest(records); !rest.empty();) {
      const std::uint64_t offset = records.size() - rest.size();
      const McapRecord record = take_mcap_record(rest, name_ + ": chunk at byte " + std::to_string(position));
      if (record.opcode == McapOpcode::message) {
        add_entry({.position = position, .offset = offset, .in_chunk = true}, record.contents, wanted, found);
      }
    }
  }

  void take_index(const ChunkPlace& chunk, const std::set<std::uint16_t>& wanted, std::vector<McapEntry>& found) {
    const std::size_t begin = found.size();
    for (const auto& [channel, position] : chunk.index_of) {
      if (!wanted.contains(channel)) {
        continue;
      }
      const McapHead head = bytes_.head_at(position);
      if (head.opcode != static_cast<std::uint8_t>(McapOpcode::message_index)) {
        fail(name_, ": the index is broken: there is no message index at byte ", position);
      }
      bytes_.read_at(position + kMcapRecordHead, bytes_.checked_length(position, head), record_);
      McapContents in(record_, name_);
      if (in.number<std::uint16_t>("channel") != channel) {
        fail(name_, ": the index is broken: the message index at byte ", position, " is not of channel ", channel);
      }
      for (McapContents entries = in.list("records"); entries.left() > 0;) {
        McapEntry entry{.position = chunk.position, .channel = channel, .in_chunk = true};
        entry.log_time_ns = entries.number<std::uint64_t>("log_time");
        entry.offset = entries.number<std::uint64_t>("offset");
        found.push_back(entry);
      }
    }
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(begin), found.end(),
              [](const McapEntry& a, const McapEntry& b) { return a.offset < b.offset; });
  }

  McapBytes bytes_;
  const std::string& name_;   ///< of bytes_
  const std::uint64_t size_;  ///< likewise
  std::string profile_;
  std::string damage_;
  Metadata metadata_;
  std::vector<McapChannel> channels_;
  bool by_index_ = false;
  bool has_counts_ = false;                        ///< there are statistics
  bool has_end_ = false;                           ///< the file's last bytes are those of an end
  std::map<std::uint16_t, std::uint64_t> counts_;  ///< messages a channel, by the statistics
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> by_id_;
  std::vector<ChunkPlace> chunks_;
  std::vector<std::uint64_t> loose_;  ///< messages outside of chunks
  std::vector<std::byte> record_;
};

McapReader::McapReader(const std::filesystem::path& file) : file_(std::make_unique<File>(file)) {}
McapReader::~McapReader() = default;
McapReader::McapReader(McapReader&&) noexcept = default;
McapReader& McapReader::operator=(McapReader&&) noexcept = default;

std::span<const McapChannel> McapReader::channels() const noexcept { return file_->channels(); }

const McapChannel* McapReader::channel(std::string_view topic) const noexcept {
  for (const McapChannel& channel : file_->channels()) {
    if (channel.topic == topic) {
      return &channel;
    }
  }
  return nullptr;
}

std::vector<std::uint16_t> McapReader::same_as(const McapChannel& channel) const {
  std::vector<std::uint16_t> ids;
  for (const McapChannel& other : file_->channels()) {
    if (other.topic == channel.topic && other.type == channel.type && other.encoding == channel.encoding) {
      ids.push_back(other.id);
    }
  }
  return ids;
}

const std::string& McapReader::profile() const noexcept { return file_->profile(); }
const std::map<std::string, std::map<std::string, std::string>>& McapReader::metadata() const noexcept {
  return file_->metadata();
}
const std::string& McapReader::damage() const noexcept { return file_->damage(); }
std::vector<McapEntry> McapReader::entries(std::span<const std::uint16_t> channels) { return file_->entries(channels); }
McapMessage McapReader::read(const McapEntry& entry) { return file_->read(entry); }

}  // namespace depthgrid::files
