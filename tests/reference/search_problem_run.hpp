// The sound search, asked a random problem.
#pragma once

#include <vector>

#include "depthgrid/search/search.hpp"
#include "reference/search_problem.hpp"

namespace depthgrid::reference {

/// A store that has taken the problem's frames, its snapshot, and a search. The problem must outlive it.
class SearchRun {
 public:
  explicit SearchRun(const SearchProblem& problem);

  /// To all primitives, in one call.
  [[nodiscard]] std::vector<Answer> distances(const search::Budget& budget = {});
  [[nodiscard]] std::vector<Answer> hybrid();
  /// The same as distances(), of a search that has been asked before, while the frames came one by one: primitive by
  /// primitive, the last one first.
  [[nodiscard]] std::vector<Answer> distances_with_history() const;

 private:
  const SearchProblem* problem_;
  views::ViewStore store_;
  views::Snapshot snapshot_;
  search::Search search_;
};

}  // namespace depthgrid::reference
