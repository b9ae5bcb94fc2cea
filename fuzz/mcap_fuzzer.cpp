// libFuzzer target: any bytes as an MCAP file, with and without the CRCs of chunks and summary made right, so that the
// fuzzer gets past them. Either it is refused with an Error of one line that prints, or every message that is listed is
// read or refused so, and lies in its channel.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/mcap_format.hpp"
#include "depthgrid/files/mcap_reader.hpp"

namespace {

using namespace depthgrid::files;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

/// The CRCs of chunks and of the summary become 0: not known. Those of a fuzzed file are wrong otherwise.
void forget_crcs(std::vector<std::byte>& file) {
  const auto zero = [&](std::size_t at) {
    std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(at), 4, std::byte{0});
  };
  std::size_t at = kMcapMagic.size();
  while (at + kMcapRecordHead <= file.size()) {
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + at + 1, sizeof length);
    const auto opcode = static_cast<McapOpcode>(file[at]);
    if (length > file.size() - at - kMcapRecordHead) {
      return;
    }
    if (opcode == McapOpcode::chunk && length >= 28) {
      zero(at + kMcapRecordHead + 24);
    }
    if (opcode == McapOpcode::footer && length == kMcapFooterBytes) {
      zero(at + kMcapRecordHead + 16);
    }
    at += kMcapRecordHead + length;
  }
}

void read_everything(const std::string& path) {
  McapReader reader(path);
  require(depthgrid::is_printable(reader.damage()));
  std::vector<std::uint16_t> channels;
  for (const McapChannel& channel : reader.channels()) {
    require(channels.empty() || channel.id > channels.back());
    channels.push_back(channel.id);
  }
  for (const McapEntry& entry : reader.entries(channels)) {
    require(std::binary_search(channels.begin(), channels.end(), entry.channel));
    try {
      const McapMessage message = reader.read(entry);
      require(message.channel == entry.channel && message.log_time_ns == entry.log_time_ns);
      std::vector<std::byte> copy(message.data.begin(), message.data.end());  // every byte can be read
      require(copy.size() <= kLargestMcapChunk);
    } catch (const depthgrid::Error& error) {
      require(depthgrid::is_printable(error.what()));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int kFile = ::memfd_create("fuzz.mcap", 0);
  static const std::string kPath = "/proc/self/fd/" + std::to_string(kFile);
  if (size == 0) {
    return 0;
  }
  const auto bytes = std::as_bytes(std::span(data + 1, size - 1));
  std::vector<std::byte> file(bytes.begin(), bytes.end());
  if (data[0] % 4 != 0) {
    forget_crcs(file);
  }
  require(kFile >= 0 && ::ftruncate(kFile, 0) == 0);
  require(::pwrite(kFile, file.data(), file.size(), 0) == static_cast<ssize_t>(file.size()));
  try {
    read_everything(kPath);
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  return 0;
}
