// diagnostic_msgs/msg/DiagnosticArray: how a program and its parts are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "depthgrid/messages/standard.hpp"

namespace depthgrid::messages {

/// diagnostic_msgs/msg/KeyValue.
struct KeyValue {
  std::string key;
  std::string value;
};

/// diagnostic_msgs/msg/DiagnosticStatus.
struct DiagnosticStatus {
  enum Level : std::uint8_t { ok = 0, warn = 1, error = 2, stale = 3 };

  std::uint8_t level = ok;
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<KeyValue> values;
};

struct Diagnostics {
  Header header;
  std::vector<DiagnosticStatus> status;
};

}  // namespace depthgrid::messages
