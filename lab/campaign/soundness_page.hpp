// The campaign's tables in the page that tells about it.
#pragma once

#include <string>

#include "lab/campaign/state_file.hpp"

namespace depthgrid::lab {

/// The tables, as Markdown.
[[nodiscard]] std::string soundness_tables(const CampaignState& state);

/// Replaces what stands between the page's two markers, kTablesBegin and kTablesEnd. Throws Error when the page cannot
/// be read or written or lacks a marker.
void write_tables(const std::string& page, const std::string& tables);

inline constexpr const char* kTablesBegin = "<!-- tables, written by depthgrid-lab campaign -->";
inline constexpr const char* kTablesEnd = "<!-- end of the tables -->";

}  // namespace depthgrid::lab
