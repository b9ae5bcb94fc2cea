// What Cyclone DDS hands out, owned. Internal.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

namespace depthgrid::dds {

/// A handle of Cyclone DDS, deleted with everything that hangs on it.
class Entity {
 public:
  Entity() = default;
  /// Throws Error where `handle` is an error of Cyclone's: "what: why".
  Entity(std::int32_t handle, std::string_view what);
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity();

  [[nodiscard]] std::int32_t handle() const noexcept { return handle_; }

 private:
  std::int32_t handle_ = 0;
};

/// From here on Cyclone DDS prints nothing, in the whole process; what it would have said stands in the errors of
/// check().
void keep_quiet() noexcept;

/// Throws Error where it is an error of Cyclone's, with what it said about it.
void check(std::int32_t result, std::string_view what);

}  // namespace depthgrid::dds
