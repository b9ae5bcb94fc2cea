#include "depthgrid/core/past.hpp"

namespace depthgrid {

std::string_view to_string(PastState state) noexcept {
  switch (state) {
    case PastState::not_told:
      return "not_told";
    case PastState::never_ruled_out:
      return "never_ruled_out";
    case PastState::possible_again:
      return "possible_again";
    case PastState::not_kept:
      return "not_kept";
    case PastState::ruled_out:
      return "ruled_out";
  }
  return "invalid";
}

}  // namespace depthgrid
