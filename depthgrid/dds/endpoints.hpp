// What publishers and subscriptions consist of. Internal.
#pragma once

#include "depthgrid/dds/entity.hpp"
#include "depthgrid/dds/publisher.hpp"
#include "depthgrid/dds/subscription.hpp"

struct ddsi_sertype;

namespace depthgrid::dds {

struct Publisher::State {
  Entity topic;
  const ddsi_sertype* type = nullptr;  ///< the topic's
  Entity writer;
};

struct Subscription::State {
  Entity topic;
  Entity reader;
  Entity condition;  ///< something waits
  Entity waiting;    ///< for the condition
};

}  // namespace depthgrid::dds
