#include "depthgrid/dds/publisher.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <utility>

#include "depthgrid/dds/byte_type.hpp"
#include "depthgrid/dds/endpoints.hpp"

namespace depthgrid::dds {

Publisher::Publisher(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Publisher::~Publisher() = default;
Publisher::Publisher(Publisher&&) noexcept = default;
Publisher& Publisher::operator=(Publisher&&) noexcept = default;

bool Publisher::write(std::span<const std::byte> message) noexcept {
  ddsi_serdata* data = make_byte_message(state_->type, message);
  return data != nullptr && dds_writecdr(state_->writer.handle(), data) == DDS_RETCODE_OK;  // which takes it over
}

std::size_t Publisher::subscribers() const noexcept {
  dds_publication_matched_status_t status{};
  const bool told = dds_get_publication_matched_status(state_->writer.handle(), &status) == DDS_RETCODE_OK;
  return told ? status.current_count : 0;
}

}  // namespace depthgrid::dds
