// The tables of random worlds in the page that tells about them.
#pragma once

#include <string>

#include "lab/worlds/worlds_state.hpp"

namespace depthgrid::lab {

/// As Markdown: worlds that keep what is assumed, kind by kind, and beside them those that break one assumption.
[[nodiscard]] std::string worlds_tables(const WorldsState& state);

/// Replaces what stands between the page's two markers. Throws Error when the page cannot be read or written or lacks a
/// marker.
void write_worlds_tables(const std::string& page, const std::string& tables);

inline constexpr const char* kWorldsBegin = "<!-- worlds, written by depthgrid-lab worlds -->";
inline constexpr const char* kWorldsEnd = "<!-- end of the worlds -->";

}  // namespace depthgrid::lab
