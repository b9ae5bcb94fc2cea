// For messages_peer.py: what the library says of types, and messages through it and back.
//
//   message_peer types           a line of four texts a type, by tabs; line ends in the definition are written \n
//   message_peer echo TYPE       messages on standard input (four bytes of length, little endian, then the bytes), each
//   read
//                                and written again to standard output in the same form
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "depthgrid/messages/serialization.hpp"

namespace {

using namespace depthgrid::messages;

void print_types() {
  for (const MessageType& type : message_types()) {
    std::string definition;
    for (const char c : type.definition) {
      definition += c == '\n' ? std::string("\\n") : std::string(1, c);
    }
    std::printf("%s\t%s\t%s\t%s\n", std::string(type.name).c_str(), std::string(type.dds_name).c_str(),
                std::string(type.hash).c_str(), definition.c_str());
  }
}

template <class Message>
bool echo(const std::string& name, const std::vector<std::byte>& in, std::vector<std::byte>& out) {
  if (name != type_of<Message>().name) {
    return false;
  }
  to_bytes(from_bytes<Message>(in), out);
  return true;
}

template <class... Message>
void echo_all(const std::string& name) {
  std::uint32_t size = 0;
  std::vector<std::byte> in;
  std::vector<std::byte> out;
  while (std::fread(&size, sizeof size, 1, stdin) == 1) {
    in.resize(size);
    if (std::fread(in.data(), 1, size, stdin) != size || !(echo<Message>(name, in, out) || ...)) {
      throw std::runtime_error("no such message: " + name);
    }
    size = static_cast<std::uint32_t>(out.size());
    std::fwrite(&size, sizeof size, 1, stdout);
    std::fwrite(out.data(), 1, size, stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 3 && std::strcmp(argv[1], "echo") == 0) {
      echo_all<Image, CompressedImage, CameraInfo, JointState, Transforms, Text, Markers, Diagnostics, Distances>(
          argv[2]);
    } else {
      print_types();
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "message_peer: %s\n", error.what());
    return 1;
  }
}
