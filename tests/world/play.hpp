// Plays a world through the sound search and judges every answer.
#pragma once

#include <functional>

#include "depthgrid/search/search_evaluator.hpp"
#include "world/tally.hpp"
#include "world/world.hpp"

namespace depthgrid::world {

/// Capsules asked at a time.
inline constexpr int kAsked = 32;

/// Plays the world from its first image to its last and adds what came of it to the tally. `spoil`, where there is one,
/// changes the answers before they are judged: for tests of the judge.
void play(const World& world, Tally& tally, const std::function<void(Answer&)>& spoil = {});

}  // namespace depthgrid::world
