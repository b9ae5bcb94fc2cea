// Random questions to the sound search, with the oracle's own version of each: everything that the search can be set
// to, drawn from a seed.
#pragma once

#include <memory>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/views/settings.hpp"
#include "reference/random_problem.hpp"
#include "reference/reference.hpp"

namespace depthgrid::reference {

/// Movable, not copyable: the frames refer to the scene's images.
struct SearchProblem {
  RandomOptions options;
  RandomProblem scene;        ///< images, and where the cameras really stand
  Rig rig;                    ///< what the search is told at first
  views::Settings settings;   ///< what the search is told
  std::vector<Frame> frames;  ///< with times; without data where a camera has not sent any
  bool moved = false;         ///< every frame comes with the pose of scene.rig, else the rig's holds
  bool ideal = false;         ///< no margins, no errors, one exposure
  Problem problem;
  std::unique_ptr<Reference> oracle;
  std::vector<Capsule> primitives;

  SearchProblem() = default;
  SearchProblem(SearchProblem&&) = default;
  SearchProblem& operator=(SearchProblem&&) = default;

  [[nodiscard]] bool present(std::size_t k) const { return frames[k].depth.data != nullptr; }
  /// A line that asks this one query again.
  [[nodiscard]] std::string line(std::size_t query) const;
};

/// With that many queries; the first ones are the same for every count.
SearchProblem make_search_problem(const RandomOptions& options, int queries);

[[nodiscard]] inline Primitive to_reference(const Capsule& capsule) { return {capsule.a, capsule.b, capsule.radius_m}; }

}  // namespace depthgrid::reference
