// What became of a frame that was handed over.
#pragma once

#include <cstdint>

namespace depthgrid {

enum class UpdateResult : std::uint8_t {
  taken,     ///< the frame is the camera's newest
  unusable,  ///< taken as "no measurement anywhere": nothing is free in this camera's view
  dropped,   ///< there is no room for it: the frame before stays the newest
};

struct FrameUpdate {
  UpdateResult result = UpdateResult::taken;
  const char* reason = "";  ///< why it was not taken, a static string; empty: it was

  [[nodiscard]] bool taken() const noexcept { return result == UpdateResult::taken; }
};

}  // namespace depthgrid
