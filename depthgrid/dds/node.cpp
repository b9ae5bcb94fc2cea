#include "depthgrid/dds/node.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/dds/byte_type.hpp"
#include "depthgrid/dds/discovery_info.hpp"
#include "depthgrid/dds/endpoints.hpp"
#include "depthgrid/dds/entity.hpp"
#include "depthgrid/dds/qos_policies.hpp"

namespace depthgrid::dds {
namespace {

constexpr int kLastDomain = 232;  ///< ports of later ones do not exist

bool is_name(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

/// Names with / between them and in front.
bool is_path(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('/', 1), text.size());
    if (text.front() != '/' || !is_name(text.substr(1, end - 1))) {
      return false;
    }
    text.remove_prefix(end);
  }
  return true;
}

void check_settings(const NodeSettings& settings) {
  if (!is_name(settings.name)) {
    fail("node name '", settings.name, "' must begin with a letter and have letters, digits and _ only");
  }
  if (settings.name_space != "/" && (settings.name_space.empty() || !is_path(settings.name_space))) {
    fail("node namespace '", settings.name_space, "' must be / or like /cell/left");
  }
  if (settings.domain < 0 || settings.domain > kLastDomain) {
    fail("DDS domain ", settings.domain, " must be from 0 to ", kLastDomain, ", the ROS_DOMAIN_ID of the other nodes");
  }
}

Guid guid_of(const Entity& entity) {
  dds_guid_t guid{};
  check(dds_get_guid(entity.handle(), &guid), "an identity");
  Guid result{};
  std::memcpy(result.data(), guid.v, result.size());
  return result;
}

/// A publisher's or a subscription's.
struct End {
  std::int32_t handle = 0;
  Guid guid{};
};

std::vector<Guid> guids_of_those_there(std::vector<End>& ends) {
  std::erase_if(ends, [](const End& end) {
    dds_guid_t guid{};
    return dds_get_guid(end.handle, &guid) != DDS_RETCODE_OK ||
           std::memcmp(guid.v, end.guid.data(), end.guid.size()) != 0;
  });
  std::vector<Guid> guids;
  guids.reserve(ends.size());
  for (const End& end : ends) {
    guids.push_back(end.guid);
  }
  return guids;
}

Entity make_participant(const NodeSettings& settings) {
  const QosPolicies policies(dds_create_qos(), [](dds_qos* p) { dds_delete_qos(p); });
  constexpr std::string_view kData = "enclave=/;";  // where other nodes look for it
  dds_qset_userdata(policies.get(), kData.data(), kData.size());
  return {dds_create_participant(static_cast<dds_domainid_t>(settings.domain), policies.get(), nullptr),
          "domain " + std::to_string(settings.domain) +
              " (is there a network, and is what CYCLONEDDS_URI names a configuration?)"};
}

}  // namespace

struct Node::State {
  explicit State(NodeSettings settings_in) : settings(std::move(settings_in)) {
    check_settings(settings);
    keep_quiet();
    if (!settings.configuration.empty()) {
      const dds_entity_t made =
          dds_create_domain(static_cast<dds_domainid_t>(settings.domain), settings.configuration.c_str());
      if (made != DDS_RETCODE_PRECONDITION_NOT_MET) {  // which means that there is one
        domain = Entity(made, "the configuration");
      }
    }
    participant = make_participant(settings);
    discovery = make_publisher("ros_discovery_info", discovery_info_type(), kLatched);
    info.participant = guid_of(participant);
    info.name_space = settings.name_space;
    info.name = settings.name;
    tell();
  }

  [[nodiscard]] Entity make_topic(const std::string& name, const messages::MessageType& type,
                                  const ddsi_sertype** used) const {
    ddsi_sertype* made = make_byte_type(std::string(type.dds_name));
    Entity topic(dds_create_topic_sertype(participant.handle(), name.c_str(), &made, nullptr, nullptr, nullptr),
                 "topic " + name);
    *used = made;  // another one, where the type was known
    return topic;
  }

  [[nodiscard]] std::unique_ptr<Publisher::State> make_publisher(const std::string& name,
                                                                 const messages::MessageType& type,
                                                                 const Qos& qos) const {
    auto made = std::make_unique<Publisher::State>();
    made->topic = make_topic(name, type, &made->type);
    const QosPolicies policies = make_policies(qos, type.hash);
    made->writer = Entity(dds_create_writer(participant.handle(), made->topic.handle(), policies.get(), nullptr),
                          "a publisher of " + name);
    return made;
  }

  /// ROS 2 puts rt before the names of its topics.
  [[nodiscard]] std::string dds_topic(const std::string& topic) const {
    const std::string prefix = settings.name_space == "/" ? "/" : settings.name_space + "/";
    const std::string full = topic.empty() || topic.front() != '/' ? prefix + topic : topic;
    if (topic.empty() || !is_path(full)) {
      fail("topic '", topic, "' must be like /camera/depth/image_raw, of letters, digits and _");
    }
    return "rt" + full;
  }

  /// An end that has gone is told of no more.
  void tell() {
    info.readers = guids_of_those_there(readers);
    info.writers = guids_of_those_there(writers);
    std::vector<std::byte> bytes;
    to_bytes(info, bytes);
    ddsi_serdata* data = make_byte_message(discovery->type, bytes);
    check(data == nullptr ? DDS_RETCODE_OUT_OF_RESOURCES : dds_writecdr(discovery->writer.handle(), data),
          "ros_discovery_info");
  }

  std::mutex one_at_a_time;
  NodeSettings settings;
  Entity domain;
  Entity participant;
  std::unique_ptr<Publisher::State> discovery;
  DiscoveryInfo info;
  std::vector<End> readers, writers;
};

Node::Node(const NodeSettings& settings) : state_(std::make_unique<State>(settings)) {}
Node::~Node() = default;
Node::Node(Node&&) noexcept = default;
Node& Node::operator=(Node&&) noexcept = default;

Publisher Node::publish(const std::string& topic, const messages::MessageType& type, const Qos& qos) {
  const std::lock_guard guard(state_->one_at_a_time);
  auto made = state_->make_publisher(state_->dds_topic(topic), type, qos);
  state_->writers.push_back({made->writer.handle(), guid_of(made->writer)});
  state_->tell();
  return Publisher(std::move(made));
}

Subscription Node::subscribe(const std::string& topic, const messages::MessageType& type, const Qos& qos) {
  const std::lock_guard guard(state_->one_at_a_time);
  auto made = std::make_unique<Subscription::State>();
  const std::string name = state_->dds_topic(topic);
  const ddsi_sertype* used = nullptr;
  made->topic = state_->make_topic(name, type, &used);
  const QosPolicies policies = make_policies(qos, type.hash);
  const std::int32_t participant = state_->participant.handle();
  made->reader = Entity(dds_create_reader(participant, made->topic.handle(), policies.get(), nullptr),
                        "a subscription of " + name);
  made->condition = Entity(dds_create_readcondition(made->reader.handle(), DDS_ANY_STATE), "a condition");
  made->waiting = Entity(dds_create_waitset(participant), "a waitset");
  check(dds_waitset_attach(made->waiting.handle(), made->condition.handle(), 0), "a waitset");
  state_->readers.push_back({made->reader.handle(), guid_of(made->reader)});
  state_->tell();
  return Subscription(std::move(made));
}

}  // namespace depthgrid::dds
