// A ROS 2 node without ROS 2: topics over Cyclone DDS, messages as bytes.
#pragma once

#include <memory>
#include <string>

#include "depthgrid/dds/publisher.hpp"
#include "depthgrid/dds/qos.hpp"
#include "depthgrid/dds/subscription.hpp"
#include "depthgrid/messages/message_type.hpp"

namespace depthgrid::dds {

struct NodeSettings {
  std::string name = "depthgrid";  ///< letters, digits and _, as ROS 2 names are
  std::string name_space = "/";    ///< begins with /
  int domain = 0;                  ///< 0 to 232: nodes of the same ROS_DOMAIN_ID see each other
  /// Configuration of Cyclone DDS (XML) instead of what CYCLONEDDS_URI names: interfaces, peers, buffers. The first
  /// node of a domain in the process decides.
  std::string configuration;
};

/// - Gives: publishers and subscriptions of topics by their ROS 2 names; other ROS 2 nodes see node, topics, types and
///   type hashes.
/// - Errors: the constructor, publish() and subscribe() throw Error.
/// - Threads: publish() and subscribe() from any. Cyclone DDS has threads of its own.
///
/// From the first node on Cyclone DDS prints nothing in the whole process; what it says of a failure stands in the
/// error.
///
/// Messages are copied once on their way out and once on their way in. Images of 640 x 480 come in fragments: where
/// the system's largest socket buffer is small (net.core.rmem_max, often 208 kB) best-effort ones get lost, and
/// reliable ones are sent again and come late; 8 MB is enough.
class Node {
 public:
  explicit Node(const NodeSettings& settings);
  ~Node();
  Node(Node&&) noexcept;
  Node& operator=(Node&&) noexcept;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// `topic`: "/depth/image_raw", or without / in the node's namespace.
  [[nodiscard]] Publisher publish(const std::string& topic, const messages::MessageType& type, const Qos& qos);
  [[nodiscard]] Subscription subscribe(const std::string& topic, const messages::MessageType& type, const Qos& qos);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::dds
