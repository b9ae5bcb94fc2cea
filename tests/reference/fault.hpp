// What may be wrong with an answer of the sound search.
#pragma once

#include <cstddef>
#include <cstdint>

namespace depthgrid::reference {

/// Worst first.
enum class Fault : std::uint8_t {
  over_estimate,  ///< a point of O is nearer than the answer
  undecided,      ///< the oracle found no nearer point of O, but could not exclude one beyond kProvenM either
  not_tight,      ///< the nearest point fails the test of tightness
  implausible,    ///< state, camera, flags or the rest of the answer contradict the images or each other
};
inline constexpr std::size_t kFaults = 4;
[[nodiscard]] const char* to_string(Fault fault);

}  // namespace depthgrid::reference
