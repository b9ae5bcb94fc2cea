// libFuzzer target: any bytes as the state of the lab's campaign. Either they are refused with an Error of one line, or
// they give tallies that can be added, written and read back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "lab/campaign/state_file.hpp"

namespace {

using namespace depthgrid::lab;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void check(const CampaignState& state) {
  const std::string text = to_text(state);
  require(to_text(parse_state(text, "written")) == text);
  CampaignState sum;
  sum.add(state);
  for (const auto& [width_px, tally] : state.tallies) {
    const auto fault = depthgrid::reference::Fault::over_estimate;
    require(tally.width_px == width_px && sum.of_width(width_px).faults(fault) == tally.faults(fault));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  CampaignState state;
  try {
    state = parse_state(text, "fuzz");
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
    return 0;
  }
  check(state);
  return 0;
}
