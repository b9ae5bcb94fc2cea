#include <dds/dds.h>

#include "depthgrid/core/error.hpp"
#include "depthgrid/dds/qos_policies.hpp"

namespace depthgrid::dds {
namespace {

/// How long a write waits for a reliable subscriber that is behind.
constexpr dds_duration_t kLongestWrite = DDS_MSECS(100);

}  // namespace

QosPolicies make_policies(const Qos& qos, std::string_view type_hash) {
  if (qos.depth < 1) {
    fail("DDS: a topic's depth is ", qos.depth, ", must be at least 1: how many messages are kept");
  }
  QosPolicies policies(dds_create_qos(), [](dds_qos* p) { dds_delete_qos(p); });
  const bool reliable = qos.reliability == Reliability::reliable;
  dds_qset_reliability(policies.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kLongestWrite);
  dds_qset_durability(policies.get(), qos.durability == Durability::transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                                                    : DDS_DURABILITY_VOLATILE);
  dds_qset_history(policies.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(policies.get(), 1, &xcdr1);
  if (!type_hash.empty()) {
    const std::string data = "typehash=" + std::string(type_hash) + ";";
    dds_qset_userdata(policies.get(), data.data(), data.size());
  }
  return policies;
}

}  // namespace depthgrid::dds
