// A stand-in of ROS 2's client library with what our component uses of it, so that the component can be compiled and
// run here: signatures as the documentation of rclcpp states them, parameters, and a timer that a test calls.
#pragma once

#include <any>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rclcpp {

class Context {
 public:
  [[nodiscard]] std::size_t get_domain_id() const { return 0; }
};

namespace node_interfaces {
class NodeBaseInterface {
 public:
  [[nodiscard]] std::shared_ptr<Context> get_context() const { return std::make_shared<Context>(); }
};
}  // namespace node_interfaces

struct Logger {
  std::shared_ptr<std::vector<std::string>> lines;
};

/// What a test gives and gets.
struct NodeOptions {
  std::map<std::string, std::any> parameters{};
  std::shared_ptr<std::vector<std::string>> log = std::make_shared<std::vector<std::string>>();
};

class TimerBase {
 public:
  using SharedPtr = std::shared_ptr<TimerBase>;
  std::function<void()> callback{};
};

class Node {
 public:
  Node(std::string name, NodeOptions options) : name_(std::move(name)), options_(std::move(options)) {}
  virtual ~Node() = default;
  template <class T>
  T declare_parameter(const std::string& name, const T& value) {
    const auto given = options_.parameters.find(name);
    return given == options_.parameters.end() ? value : std::any_cast<T>(given->second);
  }
  [[nodiscard]] const char* get_name() const { return name_.c_str(); }
  [[nodiscard]] const char* get_namespace() const { return "/"; }
  [[nodiscard]] Logger get_logger() const { return {options_.log}; }
  [[nodiscard]] std::shared_ptr<node_interfaces::NodeBaseInterface> get_node_base_interface() const {
    return std::make_shared<node_interfaces::NodeBaseInterface>();
  }
  template <class Callback>
  std::shared_ptr<TimerBase> create_wall_timer(std::chrono::milliseconds /*period*/, Callback callback) {
    auto timer = std::make_shared<TimerBase>();
    timer->callback = std::move(callback);
    timers.push_back(timer);
    return timer;
  }

  std::vector<std::weak_ptr<TimerBase>> timers{};  ///< the test's

 private:
  std::string name_;
  NodeOptions options_;
};

inline void stand_in_log(const Logger& logger, const char* /*format*/, const char* line) {
  logger.lines->push_back(line);
}

}  // namespace rclcpp

#define RCLCPP_INFO(...) rclcpp::stand_in_log(__VA_ARGS__)
#define RCLCPP_WARN(...) rclcpp::stand_in_log(__VA_ARGS__)
#define RCLCPP_ERROR(...) rclcpp::stand_in_log(__VA_ARGS__)
