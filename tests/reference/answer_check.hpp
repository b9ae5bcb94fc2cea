// Whether an answer of the sound search holds against the oracle.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "depthgrid/search/search.hpp"
#include "reference/search_problem.hpp"

namespace depthgrid::reference {

/// Proven down to this: no point of O is nearer than the answer less this.
inline constexpr double kProvenM = 0.5e-3;

/// What may be wrong with an answer, worst first.
enum class Fault : std::uint8_t {
  over_estimate,  ///< a point of O is nearer than the answer
  undecided,      ///< the oracle found no nearer point of O, but could not exclude one beyond kProvenM either
  not_tight,      ///< the nearest point fails the test of tightness
  implausible,    ///< state, camera, flags or the rest of the answer contradict the images or each other
};
inline constexpr std::size_t kFaults = 4;
[[nodiscard]] const char* to_string(Fault fault);

struct Finding {
  Fault fault;
  std::string what;
};

/// Looks at the answers of one problem, which must outlive it.
class AnswerCheck {
 public:
  explicit AnswerCheck(const SearchProblem& problem) : problem_(&problem), oracle_(problem.oracle.get()) {}

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
  [[nodiscard]] std::optional<std::string> not_tight(const Primitive& primitive, const Answer& answer) const;

  const SearchProblem* problem_;
  const Reference* oracle_;
};

}  // namespace depthgrid::reference
