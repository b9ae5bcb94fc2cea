// For mcap_peer.py: MCAP files through the library.
//
//   mcap_peer write FILE none|lz4|zstd CHUNK_BYTES     a file of fixed contents; what is in it, as read prints it, on
//   standard output mcap_peer read FILE                                a line a message: topic, type, sequence, times,
//   data in hexadecimal
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/files/mcap_writer.hpp"
#include "depthgrid/messages/serialization.hpp"

namespace {

using namespace depthgrid;

void print(const std::string& topic, std::string_view type, std::uint32_t sequence, std::uint64_t log_time_ns,
           std::uint64_t publish_time_ns, std::span<const std::byte> data) {
  std::string hex;
  for (const std::byte byte : data) {
    constexpr const char* kDigits = "0123456789abcdef";
    hex += {kDigits[std::to_integer<unsigned>(byte) >> 4U], kDigits[std::to_integer<unsigned>(byte) & 15U]};
  }
  std::printf("%s\t%s\t%u\t%llu\t%llu\t%s\n", topic.c_str(), std::string(type).c_str(), sequence,
              static_cast<unsigned long long>(log_time_ns), static_cast<unsigned long long>(publish_time_ns),
              hex.c_str());
}

void write(const std::string& file, const std::string& compression, std::size_t chunk_bytes) {
  files::McapWriter writer(file, {.compression = compression == "zstd"  ? files::McapCompression::zstd
                                                 : compression == "lz4" ? files::McapCompression::lz4
                                                                        : files::McapCompression::none,
                                  .chunk_bytes = chunk_bytes});
  const auto image_channel = writer.add_channel("/cam/depth/image_raw", messages::type_of<messages::Image>());
  const auto tf_channel = writer.add_channel("/tf_static", messages::type_of<messages::Transforms>(), true);
  const auto own_channel = writer.add_channel("/distances", messages::type_of<messages::Distances>());
  messages::Transforms transforms;
  transforms.transforms.emplace_back().child_frame_id = "cam";
  std::vector<std::uint16_t> pixels(64 * 48);
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::uint64_t time_ns = 1'700'000'000'000'000'000 + std::uint64_t{i} * 33'333'333;
    const auto put = [&](std::uint16_t channel, const char* topic, const auto& message, std::uint32_t sequence) {
      const auto bytes = to_bytes(message);
      writer.write(channel, time_ns + 7, time_ns, bytes);
      print(topic, messages::type_of<std::decay_t<decltype(message)>>().name, sequence, time_ns + 7, time_ns, bytes);
    };
    if (i == 0) {
      put(tf_channel, "/tf_static", transforms, 0);
    }
    messages::Image image;
    image.header = {.stamp = {.sec = 1'700'000'000, .nanosec = i * 33'333'333}, .frame_id = "cam"};
    image.width = 64;
    image.height = 48;
    image.encoding = "16UC1";
    image.step = 128;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      pixels[k] = static_cast<std::uint16_t>(k * 31 + i);
    }
    image.data = std::as_bytes(std::span(pixels));
    put(image_channel, "/cam/depth/image_raw", image, i);
    messages::Distances distances;
    distances.distances.emplace_back().id = "hand";
    distances.cameras = {"cam"};
    distances.image_ages = {0.25};
    put(own_channel, "/distances", distances, i);
  }
  writer.close();
}

void read(const std::string& file) {
  files::McapReader reader(file);
  std::vector<std::uint16_t> channels;
  for (const files::McapChannel& channel : reader.channels()) {
    channels.push_back(channel.id);
  }
  for (const files::McapEntry& entry : reader.entries(channels)) {
    const files::McapMessage message = reader.read(entry);
    for (const files::McapChannel& channel : reader.channels()) {
      if (channel.id == message.channel) {
        print(channel.topic, channel.type, message.sequence, message.log_time_ns, message.publish_time_ns,
              message.data);
      }
    }
  }
  if (!reader.damage().empty()) {
    throw std::runtime_error(reader.damage());
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> words(argv, argv + argc);
    if (argc == 5) {
      write(words[2], words[3], static_cast<std::size_t>(std::atoi(words[4].c_str())));
    } else if (argc == 3) {
      read(words[2]);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mcap_peer: %s\n", error.what());
    return 1;
  }
}
