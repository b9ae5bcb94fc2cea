#include "depthgrid/robot/urdfdom_messages.hpp"

#include <console_bridge/console.h>

#include <mutex>

namespace depthgrid::robot {

namespace {

std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

struct UrdfdomMessages::Handler final : console_bridge::OutputHandler {
  void log(const std::string& text, console_bridge::LogLevel level, const char* /*filename*/, int /*line*/) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
      return;
    }
    errors += errors.empty() ? "" : "; ";
    for (const char c : text) {
      errors += c == '\n' ? ' ' : c;
    }
  }
  std::unique_lock<std::mutex> lock{one_at_a_time()};
  console_bridge::OutputHandler* before = console_bridge::getOutputHandler();
  std::string errors;
};

UrdfdomMessages::UrdfdomMessages() : handler_(std::make_unique<Handler>()) {
  console_bridge::useOutputHandler(handler_.get());
}

UrdfdomMessages::~UrdfdomMessages() { console_bridge::useOutputHandler(handler_->before); }

std::string UrdfdomMessages::errors() const { return handler_->errors; }

}  // namespace depthgrid::robot
