// A stand-in: makes sure that a component can be made from options alone.
#pragma once

#include <memory>
#include <rclcpp/rclcpp.hpp>

#define RCLCPP_COMPONENTS_REGISTER_NODE(component)                                       \
  std::unique_ptr<rclcpp::Node> stand_in_component(const rclcpp::NodeOptions& options);  \
  std::unique_ptr<rclcpp::Node> stand_in_component(const rclcpp::NodeOptions& options) { \
    return std::make_unique<component>(options);                                         \
  }
