// A Qos as Cyclone DDS wants it. Internal.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "depthgrid/dds/qos.hpp"

struct dds_qos;

namespace depthgrid::dds {

using QosPolicies = std::unique_ptr<dds_qos, void (*)(dds_qos*)>;

/// `type_hash` ("RIHS01_...") goes along as user data, where other ROS 2 nodes look for it; empty: none. Throws Error.
[[nodiscard]] QosPolicies make_policies(const Qos& qos, std::string_view type_hash);

}  // namespace depthgrid::dds
