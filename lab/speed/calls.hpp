// Timed calls of the search, and what they are asked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/peers/search_peer.hpp"
#include "lab/speed/record.hpp"

namespace depthgrid::lab {

/// Of all figures but those that vary it, metres.
inline constexpr double kResolution = 0.005;

using Questions = std::vector<Capsule>;

[[nodiscard]] Questions as_points(const std::vector<Eigen::Vector3d>& points_world);
/// The seven capsules of the workload's arm.
[[nodiscard]] Questions as_links(double time_s);

/// A time between a frame set and the next, and a seed, for repetition i after a frame set.
[[nodiscard]] double time_between_s(int set, int repetition);
[[nodiscard]] std::uint64_t seed_of(int set, int repetition);

/// Calls of one kind of question over all frame sets.
class Calls {
 public:
  /// `first`: right after a frame set.
  void ask(SearchPeer& ours, const Questions& questions, bool hybrid, bool first, const search::Budget& budget = {});

  [[nodiscard]] const std::vector<Answer>& last() const { return answers_; }
  [[nodiscard]] const Samples& times_s() const { return call_s_; }
  [[nodiscard]] double total_s() const { return total_s_; }
  [[nodiscard]] Record record(const std::string& group, const std::string& name, int cameras) const;

 private:
  Samples call_s_;
  Samples first_s_;
  double total_s_ = 0;
  search::Count count_;
  double answer_count_ = 0;
  double stopped_ = 0;  ///< answers that a budget stopped
  std::vector<Answer> answers_;
};

}  // namespace depthgrid::lab
