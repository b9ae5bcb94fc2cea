// A random cell's memory and its twin, fed with the same random images.
#pragma once

#include <string>

#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/views/view_store.hpp"
#include "memory/memory_twin.hpp"
#include "memory/random_cell.hpp"

namespace depthgrid::memory {

/// Seconds between images that come in order: e to the power of something between these.
struct Gaps {
  double shortest_log = -6;
  double longest_log = -2;
};

class RandomPlay {
 public:
  explicit RandomPlay(reference::Random& random);

  /// Some camera's next image; one in five comes late. False when the views do not take it.
  [[nodiscard]] bool next(reference::Random& random, const Gaps& gaps);
  /// "image 3 of camera 1 at 12.5 s", the last one.
  [[nodiscard]] std::string text() const;

  const RandomCell cell;
  views::ViewStore views;
  MemoryStore store;
  MemoryTwin twin;

 private:
  std::size_t camera_ = 0;
  int images_ = 0;
  double time_s_;
};

}  // namespace depthgrid::memory
