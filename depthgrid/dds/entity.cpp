#include "depthgrid/dds/entity.hpp"

#include <dds/dds.h>

#include <new>
#include <string>
#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::dds {
namespace {

/// What Cyclone said last on this thread.
std::string& said() {
  thread_local std::string text;
  return text;
}

void keep(void* /*nothing*/, const dds_log_data_t* data) {
  try {
    said().assign(data->message, data->size);
  } catch (const std::bad_alloc&) {
    said().clear();
  }
}

}  // namespace

void keep_quiet() noexcept { dds_set_log_sink(keep, nullptr); }

void check(std::int32_t result, std::string_view what) {
  if (result < 0) {
    const std::string more = std::exchange(said(), {});
    const std::size_t end = more.find_last_not_of("\n ") + 1;
    fail("DDS: ", what, ": ", dds_strretcode(-result), end > 0 ? ": " : "", more.substr(0, end));
  }
}

Entity::Entity(std::int32_t handle, std::string_view what) : handle_(handle) { check(handle, what); }

Entity::~Entity() {
  if (handle_ > 0) {
    (void)dds_delete(handle_);
  }
}

}  // namespace depthgrid::dds
