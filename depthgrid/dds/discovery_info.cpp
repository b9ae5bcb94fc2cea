#include "depthgrid/dds/discovery_info.hpp"

#include "depthgrid/messages/cdr_writer.hpp"

namespace depthgrid::dds {
namespace {

/// An array of fixed length: no count.
void write(messages::CdrWriter& writer, const Guid& guid) {
  for (const std::uint8_t byte : guid) {
    writer.number(byte);
  }
}

void write(messages::CdrWriter& writer, const std::vector<Guid>& guids) {
  writer.count(guids.size());
  for (const Guid& guid : guids) {
    write(writer, guid);
  }
}

}  // namespace

const messages::MessageType& discovery_info_type() noexcept {
  static constexpr messages::MessageType kType{.name = "rmw_dds_common/msg/ParticipantEntitiesInfo",
                                               .dds_name = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                                               .hash = {},
                                               .definition = {}};
  return kType;
}

void to_bytes(const DiscoveryInfo& info, std::vector<std::byte>& bytes) {
  messages::CdrWriter writer(bytes);
  write(writer, info.participant);
  writer.count(1);
  writer.text(info.name_space);
  writer.text(info.name);
  write(writer, info.readers);
  write(writer, info.writers);
}

}  // namespace depthgrid::dds
