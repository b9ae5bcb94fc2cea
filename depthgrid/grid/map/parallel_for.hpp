// Independent pieces of work on all cores, with a report to the thread that waits for them.
#pragma once

#include <cstddef>
#include <functional>

namespace depthgrid::grid {

/// Calls work(0) .. work(pieces - 1), each once, from `threads` threads (0: one a core). Meanwhile the calling thread
/// calls report(done) about ten times a second and once at the end; when it returns false, no further piece begins.
/// Returns true when all pieces are done. An exception of `work` or `report` ends the work and is passed on.
bool parallel_for(std::size_t pieces, int threads, const std::function<void(std::size_t)>& work,
                  const std::function<bool(std::size_t)>& report);

}  // namespace depthgrid::grid
