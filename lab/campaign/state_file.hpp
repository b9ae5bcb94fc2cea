// The campaign's state in one JSON file: one tally for each width of images.
#pragma once

#include <map>
#include <string>

#include "lab/campaign/tally.hpp"

namespace depthgrid::lab {

struct CampaignState {
  std::map<int, Tally> tallies;  ///< by width_px

  /// The tally of this width, new where there is none.
  [[nodiscard]] Tally& of_width(int width_px);
  /// Throws Error when a seed is in both.
  void add(const CampaignState& other);
};

/// Writes a file beside it and renames that, so that a reader or a crash meets one whole state. Throws Error when it
/// cannot be written.
void write_state(const std::string& file, const CampaignState& state);
/// Throws Error when the file cannot be read or is no such state.
[[nodiscard]] CampaignState read_state(const std::string& file);

}  // namespace depthgrid::lab
