// One random problem of the campaign: asks the search everything about it and holds the answers against the oracle.
#pragma once

#include <cstdint>
#include <span>

#include "depthgrid/core/answer.hpp"
#include "lab/campaign/tally.hpp"
#include "reference/search_problem.hpp"

namespace depthgrid::lab {

inline constexpr int kQueriesPerProblem = 64;

/// Makes the problem of this seed (with images of tally.width_px), asks all and counts. On every tenth problem also
/// calls with a node budget, and directions; for every fiftieth query the shortfall. Adds the seed to the tally; throws
/// Error when it is there already.
void examine(std::uint64_t seed, const std::string& code, Tally& tally);

/// The parts of it, one a kind of calls. Of an unlimited call:
void examine_answers(const reference::SearchProblem& problem, std::span<const Answer> answers, Tally& tally);
/// Of one that may open `nodes` cubes.
void examine_budget_answers(const reference::SearchProblem& problem, std::span<const Answer> answers,
                            std::int64_t nodes, Tally& tally);
/// Of a search that has been asked before: the same as the fresh ones to the bit.
void examine_later_answers(const reference::SearchProblem& problem, std::span<const Answer> answers,
                           std::span<const Answer> fresh, Tally& tally);
/// With directions, beside the answers without.
void examine_directions(const reference::SearchProblem& problem, std::span<const Answer> answers,
                        std::span<const Answer> without, Tally& tally);

}  // namespace depthgrid::lab
