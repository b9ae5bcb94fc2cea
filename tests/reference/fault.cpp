#include "reference/fault.hpp"

#include <array>

namespace depthgrid::reference {

const char* to_string(Fault fault) {
  constexpr std::array<const char*, kFaults> kNames{"over_estimate", "undecided", "not_tight", "implausible"};
  return kNames.at(static_cast<std::size_t>(fault));
}

}  // namespace depthgrid::reference
