// How a topic is delivered: what publishers and subscribers have to agree on.
#pragma once

#include <cstdint>

namespace depthgrid::dds {

enum class Reliability : std::uint8_t {
  best_effort,  ///< what gets lost is lost
  reliable      ///< what gets lost is sent again, while the publisher still has it
};

enum class Durability : std::uint8_t {
  volatile_,       ///< who comes later has missed it
  transient_local  ///< who comes later gets the last `depth` messages
};

/// A subscriber hears a publisher that offers at least what it asks for: reliable where it asks for reliable,
/// transient_local where it asks for that.
struct Qos {
  Reliability reliability = Reliability::reliable;
  Durability durability = Durability::volatile_;
  int depth = 10;  ///< messages kept, the newest; 1 and more
};

/// What ROS 2 drivers call sensor data: ask for it, and both kinds of publishers are heard.
inline constexpr Qos kSensorData{Reliability::best_effort, Durability::volatile_, 5};
/// Offer it, and both kinds of subscribers hear.
inline constexpr Qos kReliable{Reliability::reliable, Durability::volatile_, 10};
/// /tf_static, /robot_description: said once, and told to whoever comes later.
inline constexpr Qos kLatched{Reliability::reliable, Durability::transient_local, 1};

}  // namespace depthgrid::dds
