#include "depthgrid/files/mcap_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_replacement.hpp"
#include "depthgrid/core/whole_file.hpp"
#include "depthgrid/files/mcap_compression.hpp"
#include "depthgrid/files/mcap_format.hpp"

namespace depthgrid::files {
namespace {

/// As rosbag2 writes it for a topic that is transient local, reliable and keeps one message.
constexpr const char* kKeepsLast =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n  deadline:\n    sec: 9223372036\n"
    "    nsec: 854775807\n  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  liveliness: 1\n"
    "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

/// Earliest and latest time of some messages.
struct Times {
  std::uint64_t first_ns = 0;
  std::uint64_t last_ns = 0;
  std::uint64_t count = 0;

  void add(std::uint64_t time_ns) {
    first_ns = count == 0 ? time_ns : std::min(first_ns, time_ns);
    last_ns = count == 0 ? time_ns : std::max(last_ns, time_ns);
    ++count;
  }
};

struct IndexEntry {
  std::uint64_t time_ns;
  std::uint64_t offset;
};

}  // namespace

class McapWriter::File {
 public:
  File(std::filesystem::path path, const McapWriterOptions& options) : path_(std::move(path)), options_(options) {
    constexpr std::size_t kLargestChunkBytes = std::size_t{1} << 26U;
    if (options.chunk_bytes < 1 || options.chunk_bytes > kLargestChunkBytes) {
      fail(path_.string(), ": chunk_bytes is ", options.chunk_bytes, ", must be from 1 to ", kLargestChunkBytes);
    }
    stream_.reset(std::fopen(replaceable_file(path_).c_str(), options.only_new ? "wbxe" : "wbe"));
    if (stream_ == nullptr && errno == EEXIST) {
      fail(path_.string(), ": is there already, and is not written over: choose another name");
    }
    if (stream_ == nullptr) {
      refuse();
    }
    put(std::as_bytes(std::span(kMcapMagic)));
    McapBuilder header;
    header.text("ros2").text("depthgrid");
    header.end_record(McapOpcode::header, records_);
    put_records();
  }

  ~File() {
    if (stream_ != nullptr) {
      try {
        end_chunk();
      } catch (const Error&) {  // nobody is left to be told
        stream_.reset();
      }
    }
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  std::uint16_t add_channel(std::string_view topic, const messages::MessageType& type, bool keeps_last) {
    require_open();
    if (topic.empty()) {
      fail(path_.string(), ": a topic's name is empty");
    }
    if (std::find(topics_.begin(), topics_.end(), topic) != topics_.end()) {
      fail(path_.string(), ": the topic '", topic, "' is there already");
    }
    if (topics_.size() == std::numeric_limits<std::uint16_t>::max()) {
      fail(path_.string(), ": has ", topics_.size(), " topics, more cannot be numbered");
    }
    topics_.emplace_back(topic);
    const auto [schema, is_new] =
        schemas_.try_emplace(std::string(type.name), static_cast<std::uint16_t>(schemas_.size() + 1));
    McapBuilder record;
    if (is_new) {
      record.number(schema->second).text(type.name).text("ros2msg").text(type.definition);
      record.end_record(McapOpcode::schema, schema_records_);
      record.number(schema->second).text(type.name).text("ros2msg").text(type.definition);
      record.end_record(McapOpcode::schema, chunk_);
    }
    const auto id = static_cast<std::uint16_t>(topics_.size());
    const std::map<std::string, std::string> metadata{{"offered_qos_profiles", keeps_last ? kKeepsLast : ""},
                                                      {"topic_type_hash", std::string(type.hash)}};
    for (std::vector<std::byte>* to : {&channel_records_, &chunk_}) {
      record.number(id).number(schema->second).text(topic).text("cdr").texts(metadata);
      record.end_record(McapOpcode::channel, *to);
    }
    index_.emplace_back();
    counts_.push_back(0);
    return id;
  }

  void write(std::uint16_t channel, std::uint64_t log_time_ns, std::uint64_t publish_time_ns,
             std::span<const std::byte> message) {
    require_open();
    if (channel < 1 || channel > topics_.size()) {
      fail(path_.string(), ": there is no channel ", channel, ", must be from 1 to ", topics_.size());
    }
    if (message.size() > kLargestMcapChunk / 2) {
      fail(path_.string(), ": a message of ", topics_[channel - 1U], " has ", message.size(),
           " bytes, must have at most ", kLargestMcapChunk / 2);
    }
    index_[channel - 1U].push_back({.time_ns = log_time_ns, .offset = chunk_.size()});
    McapBuilder record;
    record.number(channel).number(static_cast<std::uint32_t>(counts_[channel - 1U])).number(log_time_ns);
    record.number(publish_time_ns).raw(message);
    record.end_record(McapOpcode::message, chunk_);
    chunk_times_.add(log_time_ns);
    times_.add(log_time_ns);
    ++counts_[channel - 1U];
    if (chunk_.size() >= options_.chunk_bytes) {
      end_chunk();
    }
  }

  void add_metadata(std::string_view name, const std::map<std::string, std::string>& texts) {
    require_open();
    const std::uint64_t start = position_;
    McapBuilder record;
    record.text(name).texts(texts);
    record.end_record(McapOpcode::metadata, records_);
    record.number(start).number(std::uint64_t{records_.size()}).text(name);
    record.end_record(McapOpcode::metadata_index, metadata_index_records_);
    ++metadata_;
    put_records();
  }

  void flush() {
    require_open();
    end_chunk();
    if (std::fflush(stream_.get()) != 0) {
      refuse();
    }
  }

  void close() {
    require_open();
    end_chunk();
    McapBuilder record;
    record.number(data_crc_);
    record.end_record(McapOpcode::data_end, records_);
    put_records();
    put_summary();
    put(std::as_bytes(std::span(kMcapMagic)));
    if (std::fclose(stream_.release()) != 0) {
      refuse();
    }
  }

 private:
  [[noreturn]] void refuse() const {
    fail(path_.string(), ": cannot be written: ", std::generic_category().message(errno));
  }

  void require_open() const {
    if (stream_ == nullptr) {
      fail(path_.string(), ": is closed already");
    }
  }

  void put(std::span<const std::byte> bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) {
      refuse();
    }
    data_crc_ = mcap_crc(bytes, data_crc_);
    position_ += bytes.size();
  }

  void put_records() {
    put(records_);
    records_.clear();
  }

  /// The chunk, and where its messages are.
  void end_chunk() {
    if (chunk_times_.count == 0) {
      return;  // channels wait for their first message
    }
    const std::string_view name = mcap_name(options_.compression);
    mcap_compress(options_.compression, chunk_, compressed_);
    McapBuilder record;
    record.number(chunk_times_.first_ns).number(chunk_times_.last_ns).number(std::uint64_t{chunk_.size()});
    record.number(mcap_crc(chunk_)).text(name).number(std::uint64_t{compressed_.size()}).raw(compressed_);
    const std::uint64_t chunk_start = position_;
    record.end_record(McapOpcode::chunk, records_);
    put_records();
    const std::uint64_t index_start = position_;
    McapBuilder offsets;
    for (std::size_t k = 0; k < index_.size(); ++k) {
      if (index_[k].empty()) {
        continue;
      }
      const auto channel = static_cast<std::uint16_t>(k + 1);
      offsets.number(channel).number(index_start + std::uint64_t{records_.size()});
      record.number(channel).number(static_cast<std::uint32_t>(index_[k].size() * sizeof(IndexEntry)));
      for (const IndexEntry& entry : index_[k]) {
        record.number(entry.time_ns).number(entry.offset);
      }
      record.end_record(McapOpcode::message_index, records_);
      index_[k].clear();
    }
    const std::uint64_t index_bytes = records_.size();
    put_records();
    record.number(chunk_times_.first_ns).number(chunk_times_.last_ns).number(chunk_start);
    record.number(index_start - chunk_start).number(static_cast<std::uint32_t>(offsets.bytes().size()));
    record.raw(offsets.bytes()).number(index_bytes).text(name);
    record.number(std::uint64_t{compressed_.size()}).number(std::uint64_t{chunk_.size()});
    record.end_record(McapOpcode::chunk_index, chunk_index_records_);
    ++chunks_;
    chunk_.clear();
    chunk_times_ = {};
  }

  void put_summary() {
    McapBuilder record;
    record.number(times_.count).number(static_cast<std::uint16_t>(schemas_.size()));
    record.number(static_cast<std::uint32_t>(topics_.size())).number(std::uint32_t{0}).number(metadata_);
    record.number(chunks_).number(times_.first_ns).number(times_.last_ns);
    record.number(static_cast<std::uint32_t>(counts_.size() * 10));
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      record.number(static_cast<std::uint16_t>(k + 1)).number(counts_[k]);
    }
    std::vector<std::byte> statistics;
    record.end_record(McapOpcode::statistics, statistics);
    const std::uint64_t summary_start = position_;
    std::vector<std::byte> offsets;
    const std::array<std::pair<McapOpcode, const std::vector<std::byte>*>, 5> groups{
        {{McapOpcode::schema, &schema_records_},
         {McapOpcode::channel, &channel_records_},
         {McapOpcode::statistics, &statistics},
         {McapOpcode::chunk_index, &chunk_index_records_},
         {McapOpcode::metadata_index, &metadata_index_records_}}};
    for (const auto& [opcode, group] : groups) {
      if (!group->empty()) {
        record.number(static_cast<std::uint8_t>(opcode)).number(summary_start + std::uint64_t{records_.size()});
        record.number(std::uint64_t{group->size()});
        record.end_record(McapOpcode::summary_offset, offsets);
        records_.insert(records_.end(), group->begin(), group->end());
      }
    }
    const std::uint64_t offsets_start = summary_start + records_.size();
    records_.insert(records_.end(), offsets.begin(), offsets.end());
    // The CRC is of the summary and of the footer up to it.
    McapBuilder footer;
    footer.number(static_cast<std::uint8_t>(McapOpcode::footer)).number(std::uint64_t{kMcapFooterBytes});
    footer.number(summary_start).number(offsets_start);
    records_.insert(records_.end(), footer.bytes().begin(), footer.bytes().end());
    McapBuilder crc;
    crc.number(mcap_crc(records_));
    records_.insert(records_.end(), crc.bytes().begin(), crc.bytes().end());
    put_records();
  }

  std::filesystem::path path_;
  McapWriterOptions options_;
  std::unique_ptr<std::FILE, CloseStream> stream_;  ///< null: closed
  std::uint64_t position_ = 0;
  std::uint32_t data_crc_ = 0;
  std::vector<std::string> topics_;               ///< of channel 1, 2, ...
  std::vector<std::uint64_t> counts_;             ///< messages a channel
  std::vector<std::vector<IndexEntry>> index_;    ///< of the messages in chunk_, a channel
  std::map<std::string, std::uint16_t> schemas_;  ///< ids by type
  std::vector<std::byte> schema_records_;         ///< for the summary, as the next two
  std::vector<std::byte> channel_records_;
  std::vector<std::byte> chunk_index_records_;
  std::vector<std::byte> metadata_index_records_;
  std::vector<std::byte> chunk_;  ///< what was collected
  std::vector<std::byte> compressed_;
  std::vector<std::byte> records_;  ///< what is about to be written
  Times chunk_times_;
  Times times_;
  std::uint32_t chunks_ = 0;
  std::uint32_t metadata_ = 0;
};

McapWriter::McapWriter(const std::filesystem::path& file, const McapWriterOptions& options)
    : file_(std::make_unique<File>(file, options)) {}
McapWriter::~McapWriter() = default;

std::uint16_t McapWriter::add_channel(std::string_view topic, const messages::MessageType& type, bool keeps_last) {
  return file_->add_channel(topic, type, keeps_last);
}

void McapWriter::write(std::uint16_t channel, std::uint64_t log_time_ns, std::uint64_t publish_time_ns,
                       std::span<const std::byte> message) {
  file_->write(channel, log_time_ns, publish_time_ns, message);
}

void McapWriter::add_metadata(std::string_view name, const std::map<std::string, std::string>& texts) {
  file_->add_metadata(name, texts);
}

void McapWriter::flush() { file_->flush(); }
void McapWriter::close() { file_->close(); }

}  // namespace depthgrid::files
