#include "depthgrid/dds/subscription.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "depthgrid/dds/byte_type.hpp"
#include "depthgrid/dds/endpoints.hpp"

namespace depthgrid::dds {
namespace {

constexpr double kLongest_s = 1e6;

}  // namespace

Subscription::Subscription(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Subscription::~Subscription() = default;
Subscription::Subscription(Subscription&&) noexcept = default;
Subscription& Subscription::operator=(Subscription&&) noexcept = default;

Taken Subscription::take(std::vector<std::byte>& message) {
  for (;;) {
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info{};
    if (dds_takecdr(state_->reader.handle(), &data, 1, &info, DDS_ANY_STATE) <= 0) {
      return {};
    }
    const bool is_message = info.valid_data;  // else it says that a publisher has gone
    if (is_message) {
      copy_bytes(data, message);
    }
    ddsi_serdata_unref(data);
    if (is_message) {
      return {.message = true, .sent_s = 1e-9 * static_cast<double>(info.source_timestamp)};
    }
  }
}

bool Subscription::wait(double timeout_s) noexcept {
  const double bounded_s = std::isnan(timeout_s) ? 0.0 : std::clamp(timeout_s, 0.0, kLongest_s);
  dds_attach_t found = 0;
  return dds_waitset_wait(state_->waiting.handle(), &found, 1, static_cast<dds_duration_t>(1e9 * bounded_s)) > 0;
}

std::size_t Subscription::publishers() const noexcept {
  dds_subscription_matched_status_t status{};
  const bool told = dds_get_subscription_matched_status(state_->reader.handle(), &status) == DDS_RETCODE_OK;
  return told ? status.current_count : 0;
}

}  // namespace depthgrid::dds
