// What is found out about one link of an empty cell, from one padding to the next. Internal.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "depthgrid/avoidance/padded_cell.hpp"

namespace depthgrid::avoidance {

/// A link in one cell: the capsule with least left.
struct LinkReading {
  std::size_t cell = 0;
  Answer answer;

  /// Below everything where nothing is known.
  [[nodiscard]] double left_m() const noexcept {
    const double left_m = clear_of_layer_m(answer);
    return std::isnan(left_m) ? -1 : left_m;
  }
};

/// What is found out about a link, from one padding to the next.
struct LinkScan {
  std::vector<std::size_t> asked;      ///< of the problem
  bool is_told = false;                ///< larger paddings say no more of it
  bool has_ended = false;              ///< a padding after its least had not enough left
  std::vector<double> unknown_from_m;  ///< u of each reading without enough left
  std::optional<std::size_t> before;   ///< the largest padding so far at which it was not
  LinkReading worst_before;
  LinkReading worst_after;
  LinkPadding result;
};

/// Of each cell, from the answers of answers_with(). Throws Error where rho_m shows less than layer and clearance.
[[nodiscard]] std::vector<LinkReading> readings_of(const LinkScan& scan, const PaddingProblem& problem,
                                                   const std::vector<std::vector<Answer>>& answers);

/// One more padding, the settings' `padding`th, with a layer of blind_m. Paddings ascend from call to call.
void look(LinkScan& scan, std::size_t padding, const std::vector<LinkReading>& readings,
          const LeastPaddingSettings& settings, double robot_within_m, double blind_m);

}  // namespace depthgrid::avoidance
