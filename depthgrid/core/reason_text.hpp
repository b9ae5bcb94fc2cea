// What is nearest, in words: why an answer is no larger.
#pragma once

#include <span>
#include <string_view>

#include "depthgrid/core/past.hpp"
#include "depthgrid/core/proximity.hpp"

namespace depthgrid {

/// "a surface", "space without a reading, never seen free", "space hidden behind a surface, where nothing could be
/// until 0.8 s ago, then something from space never seen free 0.41 m from there".
/// - Takes: an answer's nearest; what a memory knows of it (DistanceEvaluator::past(), Past{} without one); the time
///   from which seconds are counted back, on the frames' clock.
/// - Gives: words, at most as long as the buffer; 240 characters are enough. Locks and allocates nothing.
[[nodiscard]] std::string_view reason_text(const Proximity& nearest, const Past& past, double now_s,
                                           std::span<char> buffer) noexcept;

}  // namespace depthgrid
