// Whether an answer of the sound search holds against the oracle.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "depthgrid/search/search.hpp"
#include "reference/fault.hpp"
#include "reference/search_problem.hpp"

namespace depthgrid::reference {

/// Proven down to this: no point of O is nearer than the answer less this.
inline constexpr double kProvenM = 0.5e-3;

struct Finding {
  Fault fault;
  std::string what;
};

/// Looks at the answers of one problem, which must outlive it. `box_limit`: what the oracle may look at for an answer.
class AnswerCheck {
 public:
  explicit AnswerCheck(const SearchProblem& problem, std::int64_t box_limit = SearchSettings{}.box_limit)
      : problem_(&problem), oracle_(problem.oracle.get()), box_limit_(box_limit) {}

  /// Everything but soundness: form, state and, where no budget stopped it, tightness.
  [[nodiscard]] std::optional<Finding> form(const Capsule& primitive, const Answer& answer) const;

  struct Soundness {
    std::optional<Finding> finding;
    double proven_m = 0;     ///< no point of O is nearer than this
    std::int64_t boxes = 0;  ///< that the oracle looked at
  };
  /// No point of O is nearer than the answer.
  [[nodiscard]] Soundness soundness(const Capsule& primitive, const Answer& answer) const;

 private:
  [[nodiscard]] std::optional<std::string> implausible(const Primitive& primitive, const Answer& answer) const;
  [[nodiscard]] std::optional<std::string> implausible_state(const Eigen::Vector3d& nearest_world,
                                                             const Answer& answer) const;
  /// The camera frees the ball only because readings show the robot that do not, rounded as the search rounds.
  [[nodiscard]] bool frees_by_a_tie(std::size_t k, const Eigen::Vector3d& w, double radius_m) const;
  [[nodiscard]] std::optional<std::string> not_tight(const Primitive& primitive, const Answer& answer) const;

  const SearchProblem* problem_;
  const Reference* oracle_;
  std::int64_t box_limit_;
};

}  // namespace depthgrid::reference
