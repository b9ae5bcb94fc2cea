// What tells other ROS 2 nodes that this one has a name and which topics are its: the topic ros_discovery_info.
// Internal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "depthgrid/messages/message_type.hpp"

namespace depthgrid::dds {

/// Of a participant, a writer or a reader, as DDS has it.
using Guid = std::array<std::uint8_t, 16>;

/// Since Iron a Gid has 16 bytes; nodes up to Humble (24 bytes) cannot read it, and show this one without a name.
struct DiscoveryInfo {
  Guid participant{};
  std::string name_space;
  std::string name;
  std::vector<Guid> readers;
  std::vector<Guid> writers;
};

[[nodiscard]] const messages::MessageType& discovery_info_type() noexcept;
/// rmw_dds_common/msg/ParticipantEntitiesInfo with this node alone, CDR.
void to_bytes(const DiscoveryInfo& info, std::vector<std::byte>& bytes);

}  // namespace depthgrid::dds
