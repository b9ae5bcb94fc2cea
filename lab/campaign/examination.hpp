// One random problem of the campaign: asks the search everything about it and holds the answers against the oracle.
#pragma once

#include <span>

#include "lab/campaign/tally.hpp"
#include "reference/search_problem.hpp"

namespace depthgrid::lab {

inline constexpr int kQueriesPerProblem = 64;

/// Makes the problem of this seed (with images of tally.width_px), asks all and counts. On every tenth problem also
/// calls with a node budget, and directions; for every fiftieth query the shortfall. Adds the seed to the tally; throws
/// Error when it is there already.
void examine(std::uint64_t seed, const std::string& code, Tally& tally);

/// The part of it that looks at the answers of an unlimited call.
void examine_answers(const reference::SearchProblem& problem, std::span<const Answer> answers, Tally& tally);

}  // namespace depthgrid::lab
