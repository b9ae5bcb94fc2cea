// The campaign's state in one JSON file: one tally for each width of images.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "lab/campaign/tally.hpp"

namespace depthgrid::lab {

struct CampaignState {
  std::map<int, Tally> tallies;  ///< by width_px

  /// The tally of this width, new where there is none.
  [[nodiscard]] Tally& of_width(int width_px);
  /// Throws Error when a seed is in both.
  void add(const CampaignState& other);
  /// Any of the tallies is.
  [[nodiscard]] bool is_unsound() const;
};

[[nodiscard]] std::string to_text(const CampaignState& state);
/// Throws Error of one line, beginning with `name`, unless the text is such a state and whole: every key is there,
/// every count is a count, and the problems that were looked at are those of the seeds.
[[nodiscard]] CampaignState parse_state(std::string_view text, const std::string& name);

/// Writes a file beside it and renames that, so that a reader or a crash meets one whole state. Throws Error when it
/// cannot be written.
void write_state(const std::string& file, const CampaignState& state);
/// Throws Error as parse_state(), or when the file cannot be read.
[[nodiscard]] CampaignState read_state(const std::string& file);

}  // namespace depthgrid::lab
