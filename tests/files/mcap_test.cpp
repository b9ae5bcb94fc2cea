// Recordings as MCAP files: what is written is read, also of a file that is cut anywhere; broken files are refused in a
// line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/mcap_compression.hpp"
#include "depthgrid/files/mcap_format.hpp"
#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/files/mcap_writer.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "files/memory_file.hpp"
#include "files/temporary_folder.hpp"
#include "support/random_run.hpp"

namespace depthgrid::files {
namespace {

using test::MemoryFile;
using test::message_of;
using test::read_bytes;
using test::TemporaryFolder;
using ::testing::HasSubstr;

/// What a test wrote, in its order.
struct Written {
  std::uint16_t channel;
  std::uint64_t log_time_ns;
  std::string data;
};

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Three topics of two types, `count` messages of random times and sizes. Closed, or not.
std::vector<Written> write_small(const std::filesystem::path& file, const McapWriterOptions& options, int count = 20,
                                 bool closed = true) {
  McapWriter writer(file, options);
  const std::uint16_t text = writer.add_channel("/text", messages::type_of<messages::Text>());
  const std::uint16_t transforms = writer.add_channel("/tf_static", messages::type_of<messages::Transforms>(), true);
  const std::uint16_t other = writer.add_channel("/other", messages::type_of<messages::Text>());
  std::mt19937 random(3);
  std::vector<Written> all;
  for (int i = 0; i < count; ++i) {
    const std::uint16_t channel = i == 2 ? transforms : i % 3 == 0 ? other : text;
    const auto bytes = to_bytes(messages::Text{"message " + std::to_string(i) + std::string(random() % 20, 'x')});
    const std::uint64_t time_ns = 1'000'000'000'000 + static_cast<std::uint64_t>(i) * 1000 - random() % 3000;
    writer.write(channel, time_ns, time_ns - 5, bytes);
    all.push_back({channel, time_ns, text_of(bytes)});
  }
  if (closed) {
    writer.close();
  }
  return all;
}

std::vector<Written> read_all(McapReader& reader) {
  std::vector<std::uint16_t> channels;
  for (const McapChannel& channel : reader.channels()) {
    channels.push_back(channel.id);
  }
  std::vector<Written> all;
  for (const McapEntry& entry : reader.entries(channels)) {
    const McapMessage message = reader.read(entry);
    EXPECT_EQ(message.log_time_ns, entry.log_time_ns);
    all.push_back({message.channel, message.log_time_ns, text_of(message.data)});
  }
  return all;
}

std::vector<Written> read_all(const std::filesystem::path& file) {
  McapReader reader(file);
  return read_all(reader);
}

bool operator==(const Written& a, const Written& b) {
  return a.channel == b.channel && a.log_time_ns == b.log_time_ns && a.data == b.data;
}

class EveryCompression : public ::testing::TestWithParam<McapCompression> {};
INSTANTIATE_TEST_SUITE_P(Mcap, EveryCompression,
                         ::testing::Values(McapCompression::none, McapCompression::lz4, McapCompression::zstd));

TEST_P(EveryCompression, WhatIsWrittenIsRead) {
  for (const std::size_t chunk_bytes : {1U, 300U, 100'000U}) {
    const TemporaryFolder folder;
    const auto all = write_small(folder / "a.mcap", {.compression = GetParam(), .chunk_bytes = chunk_bytes});
    McapReader reader(folder / "a.mcap");
    EXPECT_EQ(reader.damage(), "");
    EXPECT_EQ(reader.profile(), "ros2");
    ASSERT_EQ(reader.channels().size(), 3U);
    const McapChannel& channel = reader.channels()[1];
    EXPECT_EQ(channel.topic, "/tf_static");
    EXPECT_EQ(channel.encoding, "cdr");
    EXPECT_EQ(channel.type, "tf2_msgs/msg/TFMessage");
    EXPECT_EQ(channel.schema_encoding, "ros2msg");
    EXPECT_EQ(channel.definition, messages::type_of<messages::Transforms>().definition);
    EXPECT_EQ(channel.metadata.at("topic_type_hash"), messages::type_of<messages::Transforms>().hash);
    EXPECT_THAT(channel.metadata.at("offered_qos_profiles"), HasSubstr("durability: 1"));
    EXPECT_EQ(reader.channel("/other")->id, 3);
    EXPECT_EQ(reader.channel("/none"), nullptr);
    EXPECT_EQ(read_all(reader), all);
    EXPECT_EQ(reader.entries(2).size(), 1U);
    EXPECT_EQ(reader.damage(), "");
  }
}

TEST_P(EveryCompression, WithoutSummaryTheSameIsRead) {
  const TemporaryFolder folder;
  const auto all = write_small(folder / "a.mcap", {.compression = GetParam(), .chunk_bytes = 200}, 20, false);
  McapReader reader(folder / "a.mcap");
  EXPECT_THAT(reader.damage(), HasSubstr("without the mark of its end"));
  EXPECT_EQ(read_all(reader), all);
}

/// Whatever is left of the file gives the messages of the chunks that are whole in it, and never another one.
TEST_P(EveryCompression, CutAtAnyByteItIsReadUpToThere) {
  const TemporaryFolder folder;
  const auto all = write_small(folder / "a.mcap", {.compression = GetParam(), .chunk_bytes = 150}, 12);
  const std::string bytes = read_bytes(folder / "a.mcap");
  // Where each chunk ends, and how many messages there are up to there.
  std::vector<std::pair<std::size_t, std::size_t>> ends;
  {
    McapReader reader(folder / "a.mcap");
    const std::vector<std::uint16_t> channels{1, 2, 3};
    const auto entries = reader.entries(channels);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      McapContents head(std::as_bytes(std::span(bytes)).subspan(entries[i].position + 1), "test");
      const std::size_t end = entries[i].position + kMcapRecordHead + head.number<std::uint64_t>("length");
      if (ends.empty() || ends.back().first != end) {
        ends.emplace_back(end, 0);
      }
      ends.back().second = i + 1;
    }
  }
  ASSERT_GT(ends.size(), 3U);
  const MemoryFile cut;
  const auto file = cut.path();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    cut.write(std::string_view(bytes).substr(0, size));
    if (size < kMcapMagic.size()) {
      EXPECT_THAT(message_of([&] { static_cast<void>(read_all(file)); }), HasSubstr(": is no MCAP file: "));
      continue;
    }
    std::size_t whole = 0;
    for (const auto& [end, count] : ends) {
      whole = end <= size ? count : whole;
    }
    McapReader reader(file);
    EXPECT_NE(reader.damage(), "") << size;
    const auto read = read_all(reader);
    ASSERT_EQ(read, std::vector<Written>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(whole))) << size;
  }
}

/// Any byte of a file set to another value: what is read is what was written, or the file is refused.
TEST_P(EveryCompression, AChangedByteChangesNoMessage) {
  const TemporaryFolder folder;
  const auto all = write_small(folder / "a.mcap", {.compression = GetParam(), .chunk_bytes = 250}, 10);
  const std::string bytes = read_bytes(folder / "a.mcap");
  int refused = 0;
  const MemoryFile other;
  const auto file = other.path();
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ (at % 2 == 0 ? 1 : 0x80));
    other.write(changed);
    try {
      for (const Written& message : read_all(file)) {
        EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Written& w) { return w.data == message.data; }))
            << at;
      }
    } catch (const Error& error) {
      EXPECT_TRUE(is_printable(error.what())) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(file.string() + ": "));
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

// Files by hand.

struct ByHand {
  std::vector<std::byte> bytes;
  McapBuilder record;

  ByHand() {
    const auto magic = std::as_bytes(std::span(kMcapMagic));
    bytes.assign(magic.begin(), magic.end());
    record.text("ros2").text("by hand");
    end(McapOpcode::header);
  }
  void end(McapOpcode opcode) { record.end_record(opcode, bytes); }
  void schema_and_channel(std::vector<std::byte>& to) {
    record.number(std::uint16_t{1}).text("std_msgs/msg/String").text("ros2msg").text("string data\n");
    record.end_record(McapOpcode::schema, to);
    record.number(std::uint16_t{7}).number(std::uint16_t{1}).text("/text").text("cdr").texts({});
    record.end_record(McapOpcode::channel, to);
  }
  void message(std::vector<std::byte>& to, std::string_view data, std::uint16_t channel = 7) {
    record.number(channel).number(std::uint32_t{1}).number(std::uint64_t{5}).number(std::uint64_t{6});
    record.raw(std::as_bytes(std::span(data)));
    record.end_record(McapOpcode::message, to);
  }
  void chunk(std::string_view compression, std::uint64_t size, std::uint32_t crc, std::span<const std::byte> data) {
    record.number(std::uint64_t{5}).number(std::uint64_t{5}).number(size).number(crc).text(compression);
    record.number(std::uint64_t{data.size()}).raw(data);
    end(McapOpcode::chunk);
  }
  void close(std::uint64_t summary_start = 0) {
    record.number(std::uint64_t{summary_start}).number(std::uint64_t{0}).number(std::uint32_t{0});
    end(McapOpcode::footer);
    const auto magic = std::as_bytes(std::span(kMcapMagic));
    bytes.insert(bytes.end(), magic.begin(), magic.end());
  }
  [[nodiscard]] std::filesystem::path in(const TemporaryFolder& folder) const {
    return folder.write("hand.mcap", text_of(bytes));
  }
};

TEST(McapByHand, MessagesOutsideOfChunksAndUnknownRecordsAreNoTrouble) {
  const TemporaryFolder folder;
  ByHand file;
  file.schema_and_channel(file.bytes);
  file.record.text("something").number(std::uint64_t{1});
  file.end(static_cast<McapOpcode>(0x90));
  file.record.text("an attachment of another form");
  file.end(static_cast<McapOpcode>(9));
  file.message(file.bytes, "first");
  std::vector<std::byte> inner;
  file.record.text("unknown in a chunk");
  file.record.end_record(static_cast<McapOpcode>(0x77), inner);
  file.message(inner, "second");
  file.chunk("", inner.size(), 0, inner);  // without a CRC
  file.record.number(std::uint32_t{0});
  file.end(McapOpcode::data_end);
  file.close();
  McapReader reader(file.in(folder));
  EXPECT_EQ(reader.damage(), "");
  std::vector<std::string> texts;
  for (const McapEntry& entry : reader.entries(7)) {
    texts.push_back(text_of(reader.read(entry).data));
  }
  EXPECT_THAT(texts, ::testing::UnorderedElementsAre("first", "second"));
}

TEST(McapByHand, TheHintOfANewerFieldIsPassedOver) {
  const TemporaryFolder folder;
  ByHand file;
  file.record.number(std::uint16_t{7}).number(std::uint16_t{0}).text("/text").text("cdr").texts({}).text("newer");
  file.end(McapOpcode::channel);
  file.close();
  const McapReader reader(file.in(folder));
  EXPECT_EQ(reader.channel("/text")->type, "");
}

struct Broken {
  const char* name;
  std::function<void(ByHand&)> make;
  const char* message;  ///< a part of it
};

class BrokenMcap : public ::testing::TestWithParam<Broken> {};

std::vector<std::byte> compressed(McapCompression compression, const std::vector<std::byte>& bytes) {
  std::vector<std::byte> out;
  mcap_compress(compression, bytes, out);
  return out;
}

INSTANTIATE_TEST_SUITE_P(
    Mcap, BrokenMcap,
    ::testing::Values(
        Broken{"Empty", [](ByHand& f) { f.bytes.clear(); }, "is no MCAP file: it is empty"},
        Broken{"NoMagic", [](ByHand& f) { f.bytes[3] = std::byte{'X'}; }, "its first bytes are not those of MCAP"},
        Broken{"ZstdFile", [](ByHand& f) { f.bytes = compressed(McapCompression::zstd, f.bytes); },
               "is a file compressed as a whole with zstd"},
        Broken{"ChunkOfATerabyte", [](ByHand& f) { f.chunk("zstd", std::uint64_t{1} << 40U, 0, {}); },
               "has 1099511627776 bytes decompressed, must have at most 268435456"},
        Broken{"MoreThanPromised",
               [](ByHand& f) {
                 f.chunk("zstd", 10, 0, compressed(McapCompression::zstd, std::vector<std::byte>(50'000'000)));
               },
               "its data has more than 10 bytes, 10 are promised"},
        Broken{"LessThanPromised",
               [](ByHand& f) {
                 f.chunk("lz4", 200'000'000, 0, compressed(McapCompression::lz4, std::vector<std::byte>(1000)));
               },
               "its data has only 1000 bytes, 200000000 are promised"},
        Broken{"UncompressedOfAnotherSize", [](ByHand& f) { f.chunk("", 3, 0, std::vector<std::byte>(4)); },
               "its data has 4 bytes, 3 are promised"},
        Broken{"NoZstd", [](ByHand& f) { f.chunk("zstd", 4, 0, std::vector<std::byte>(40, std::byte{7})); },
               "broken zstd data: "},
        Broken{"NoLz4", [](ByHand& f) { f.chunk("lz4", 4, 0, std::vector<std::byte>(40, std::byte{7})); },
               "broken LZ4 data: "},
        Broken{"UnknownCompression", [](ByHand& f) { f.chunk("bz2\x1b", 4, 0, std::vector<std::byte>(4)); },
               "is compressed with 'bz2\\x1b', known are zstd, lz4 and none"},
        Broken{"WrongCrc",
               [](ByHand& f) {
                 std::vector<std::byte> inner;
                 f.message(inner, "text");
                 f.chunk("", inner.size(), mcap_crc(inner) + 1, inner);
               },
               "its CRC is wrong: the file is damaged"},
        Broken{"RecordBeyondItsChunk",
               [](ByHand& f) {
                 std::vector<std::byte> inner;
                 f.message(inner, "text");
                 inner.pop_back();
                 f.chunk("", inner.size(), 0, inner);
               },
               "'record' needs 26 bytes, its record has 25 left"},
        Broken{"TextBeyondItsRecord",
               [](ByHand& f) {
                 f.record.number(std::uint16_t{1}).number(std::uint16_t{0}).number(std::uint32_t{0xFFFFFFFF});
                 f.end(McapOpcode::channel);
               },
               "'topic' needs 4294967295 bytes, its record has 0 left"},
        Broken{"OneChannelTwice",
               [](ByHand& f) {
                 for (const char* topic : {"/a", "/b"}) {
                   f.record.number(std::uint16_t{1}).number(std::uint16_t{0}).text(topic).text("cdr").texts({});
                   f.end(McapOpcode::channel);
                 }
               },
               "channel 1 is '/a' in one place and '/b' in another"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_P(BrokenMcap, IsRefusedInOneLine) {
  const TemporaryFolder folder;
  ByHand file;
  GetParam().make(file);
  if (file.bytes.size() > kMcapMagic.size() && std::string(GetParam().name) != "ZstdFile") {
    file.close();
  }
  const auto path = file.in(folder);
  const std::string why = message_of([&] { static_cast<void>(read_all(path)); }, folder.path());
  EXPECT_THAT(why, ::testing::StartsWith("hand.mcap: "));
  EXPECT_THAT(why, HasSubstr(GetParam().message));
  EXPECT_TRUE(is_printable(why)) << why;
}

TEST(McapByHand, ALengthOfExabytesIsWhereTheFileEnds) {
  const TemporaryFolder folder;
  ByHand file;
  file.schema_and_channel(file.bytes);
  file.message(file.bytes, "first");
  McapBuilder head;
  head.number(std::uint8_t{6}).number(std::uint64_t{0xFFFFFFFFFFFFFFFF});
  file.bytes.insert(file.bytes.end(), head.bytes().begin(), head.bytes().end());
  file.close();
  McapReader reader(file.in(folder));
  EXPECT_THAT(reader.damage(), HasSubstr("within the record at byte"));
  EXPECT_EQ(reader.entries(7).size(), 1U);
}

/// An index that leads elsewhere is not believed: the file is read from its beginning.
TEST(McapByHand, ABrokenIndexIsNotUsed) {
  const TemporaryFolder folder;
  const auto all = write_small(folder / "a.mcap", {.compression = McapCompression::none, .chunk_bytes = 300}, 10);
  std::string bytes = read_bytes(folder / "a.mcap");
  // The first message index record follows the first chunk; its opcode becomes one that is not known.
  McapReader whole(folder / "a.mcap");
  const std::size_t chunk = whole.entries(1).front().position;
  McapContents length(std::as_bytes(std::span(bytes)).subspan(chunk + 1), "test");
  bytes[chunk + kMcapRecordHead + length.number<std::uint64_t>("length")] = 0x70;
  McapReader reader(folder.write("b.mcap", bytes));
  EXPECT_EQ(read_all(reader), all);
  EXPECT_THAT(reader.damage(), HasSubstr("its index is not used: "));
}

/// A message that lies beside the chunks is in no index; only the statistics know of it.
TEST(McapByHand, AnIndexThatListsTooFewIsNotUsed) {
  const TemporaryFolder folder;
  ByHand file;
  std::vector<std::byte> inner;
  file.schema_and_channel(inner);
  const std::uint64_t offset = inner.size();
  file.message(inner, "in the chunk");
  const std::uint64_t chunk = file.bytes.size();
  file.chunk("", inner.size(), 0, inner);
  const std::uint64_t index = file.bytes.size();
  file.record.number(std::uint16_t{7}).number(std::uint32_t{16}).number(std::uint64_t{5}).number(offset);
  file.end(McapOpcode::message_index);
  file.message(file.bytes, "beside it");
  file.record.number(std::uint32_t{0});
  file.end(McapOpcode::data_end);
  const std::uint64_t summary = file.bytes.size();
  file.schema_and_channel(file.bytes);
  file.record.number(std::uint64_t{2}).number(std::uint16_t{1}).number(std::uint32_t{1}).number(std::uint32_t{0});
  file.record.number(std::uint32_t{0}).number(std::uint32_t{1}).number(std::uint64_t{5}).number(std::uint64_t{5});
  file.record.number(std::uint32_t{10}).number(std::uint16_t{7}).number(std::uint64_t{2});
  file.end(McapOpcode::statistics);
  file.record.number(std::uint64_t{5}).number(std::uint64_t{5}).number(chunk).number(index - chunk);
  file.record.number(std::uint32_t{10}).number(std::uint16_t{7}).number(index).number(std::uint64_t{0});
  file.record.text("").number(std::uint64_t{inner.size()}).number(std::uint64_t{inner.size()});
  file.end(McapOpcode::chunk_index);
  file.close(summary);
  McapReader reader(file.in(folder));
  EXPECT_EQ(reader.damage(), "");
  EXPECT_EQ(reader.entries(7).size(), 2U);
  EXPECT_THAT(reader.damage(), HasSubstr("it lists 1 messages, the statistics count 2"));
}

TEST(McapWriter, RefusesWhatCannotBeRead) {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap");
  const auto& type = messages::type_of<messages::Text>();
  static_cast<void>(writer.add_channel("/a", type));
  EXPECT_THAT(message_of([&] { static_cast<void>(writer.add_channel("/a", type)); }), HasSubstr("is there already"));
  EXPECT_THAT(message_of([&] { static_cast<void>(writer.add_channel("", type)); }), HasSubstr("name is empty"));
  EXPECT_THAT(message_of([&] { writer.write(2, 0, 0, {}); }), HasSubstr("there is no channel 2, must be from 1 to 1"));
  writer.close();
  EXPECT_THAT(message_of([&] { writer.write(1, 0, 0, {}); }), HasSubstr("is closed already"));
  EXPECT_THAT(message_of([&] { McapWriter(folder / "a.mcap", {.compression = {}, .chunk_bytes = 0}); }),
              HasSubstr("chunk_bytes is 0"));
  EXPECT_THAT(message_of([&] { McapWriter(folder / "none" / "a.mcap"); }), HasSubstr("a.mcap: "));
  EXPECT_THAT(message_of([&] { McapWriter(folder.path()); }), HasSubstr(folder.path().string()));
}

TEST(McapWriter, AFileWithoutMessagesIsRead) {
  const TemporaryFolder folder;
  {
    McapWriter writer(folder / "a.mcap");
    static_cast<void>(writer.add_channel("/a", messages::type_of<messages::Text>()));
    writer.close();
  }
  McapReader reader(folder / "a.mcap");
  EXPECT_EQ(reader.damage(), "");
  EXPECT_EQ(reader.entries(1).size(), 0U);
}

TEST(McapWriter, FlushedMessagesAreThere) {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap");
  const std::uint16_t channel = writer.add_channel("/a", messages::type_of<messages::Text>());
  writer.write(channel, 1, 1, to_bytes(messages::Text{"a"}));
  writer.flush();
  EXPECT_EQ(read_all(folder / "a.mcap").size(), 1U);
}

TEST(McapReader, RandomBytesAreReadOrRefused) {
  const TemporaryFolder folder;
  const MemoryFile other;
  const auto file = other.path();
  const auto run = test::random_run(3000);
  std::mt19937_64 random(run.seed);
  for (const McapCompression compression : {McapCompression::none, McapCompression::zstd, McapCompression::lz4}) {
    write_small(folder / "a.mcap", {.compression = compression, .chunk_bytes = 250}, 10);
    const std::string bytes = read_bytes(folder / "a.mcap");
    for (std::int64_t i = 0; i < run.count / 3; ++i) {
      std::string changed = bytes;
      for (std::uint64_t k = random() % 5; k < 6; ++k) {
        changed[8 + random() % (changed.size() - 8)] = static_cast<char>(random() % 2 == 0 ? random() : 0xFF);
      }
      other.write(changed);
      try {
        static_cast<void>(read_all(file));
      } catch (const Error& error) {
        EXPECT_TRUE(is_printable(error.what())) << error.what() << '\n' << run.reproduce();
      }
    }
  }
}

}  // namespace
}  // namespace depthgrid::files
