#include <limits>
#include <string>
#include <utility>

#include "lab/speed/goals.hpp"

namespace depthgrid::lab {
namespace {

constexpr const char* kW = kWorkloadNames[0].key;
constexpr const char* kRemoved = kWorkloadNames[1].key;
constexpr const char* kNoisy = kWorkloadNames[2].key;

/// Collects the goals of one report.
class AimedGoals {
 public:
  explicit AimedGoals(const Report& report) : report_(report) {}

  /// A time of a row of ours, milliseconds.
  void milliseconds(const char* what, const char* row, const char* key, const char* workload, double goal, double aim) {
    goals_.push_back({what, workload, "ms", goal, aim, 1e3 * ours(workload, row, key, 2)});
  }
  /// A peer's whole cycle in times of ours, measured in turns.
  void cycle(const char* peer, const char* workload, double goal, double aim) {
    const Record* row = report_.find(std::string("side by side, ") + workload, peer, {{"cameras", 2}});
    const double ratio = row != nullptr ? (*row)["cycle_median_s"] / (*row)["our_cycle_median_s"]
                                        : std::numeric_limits<double>::quiet_NaN();
    goals_.push_back({std::string("cycle of ") + peer, workload, "times ours", goal, aim, ratio});
  }
  void eight_cameras(double goal, double aim) {
    const double ratio = ours(kW, "nine points", "call_mean_s", 8) / ours(kW, "nine points", "call_mean_s", 2);
    goals_.push_back({"nine points, eight cameras", kW, "times two cameras", goal, aim, ratio});
  }
  void letter(double goal, double aim) {
    const double mean_s =
        report_.number("call_mean_s", std::string("beside the letter, ") + kW, "letter, hybrid", {{"cameras", 2}});
    goals_.push_back({"`letter` with its hybrid vector", kW, "a second", goal, aim, 1 / mean_s});
  }
  [[nodiscard]] std::vector<AimedGoal> take() { return std::move(goals_); }

 private:
  [[nodiscard]] double ours(const char* workload, const char* row, const char* key, double cameras) const {
    return report_.number(key, std::string("ours, ") + workload, row, {{"cameras", cameras}});
  }

  const Report& report_;
  std::vector<AimedGoal> goals_;
};

}  // namespace

std::vector<AimedGoal> goals_with_verdicts(const Report& report) {
  AimedGoals goals(report);
  goals.milliseconds("nine points, mean of all calls", "nine points", "call_mean_s", kW, 0.03, 0.02);
  goals.milliseconds("nine points, mean of all calls", "nine points", "call_mean_s", kNoisy, 0.2, 0.1);
  goals.milliseconds("nine points, first call after a frame set", "nine points", "first_median_s", kW, 0.25, 0.12);
  goals.milliseconds("nine points, first call after a frame set", "nine points", "first_median_s", kNoisy, 1, 0.5);
  goals.milliseconds("100 points, first call", "100 points", "first_median_s", kW, 0.8, 0.5);
  goals.milliseconds("100 points", "100 points", "call_median_s", kW, 0.3, 0.15);
  goals.milliseconds("seven link capsules, first call", "seven link capsules", "first_median_s", kW, 1.5, 0.8);
  goals.milliseconds("seven link capsules, first call", "seven link capsules", "first_median_s", kNoisy, 5, 2);
  goals.milliseconds("seven link capsules", "seven link capsules", "call_median_s", kW, 0.2, 0.1);
  goals.milliseconds("seven link capsules", "seven link capsules", "call_median_s", kNoisy, 0.8, 0.4);
  goals.eight_cameras(1.3, 1.1);
  goals.milliseconds("nine points, hybrid", "nine points, hybrid", "call_median_s", kW, 0.1, 0.05);
  goals.milliseconds("an image in, 640 x 480", "image in", "call_median_s", kRemoved, 0.12, 0.06);
  goals.milliseconds("an image in, 640 x 480", "image in", "call_median_s", kW, 0.2, 0.1);
  goals.milliseconds("an image in, 640 x 480", "image in", "call_median_s", kNoisy, 0.3, 0.15);
  const char* const renewed = "nine points, a new snapshot for every call";
  goals.milliseconds(renewed, renewed, "call_median_s", kW, 0.2, 0.1);
  goals.milliseconds(renewed, renewed, "call_median_s", kNoisy, 1, 0.4);
  const char* const remembered = "nine points, with a memory";
  goals.milliseconds("nine points, with a memory, first call after a frame set", remembered, "first_median_s", kNoisy,
                     0.3, 0.3);
  goals.milliseconds(remembered, remembered, "call_median_s", kNoisy, 0.05, 0.05);
  goals.cycle("nanoflann, cell", kW, 45, 90);
  goals.cycle("nanoflann, cell", kRemoved, 60, 100);
  goals.cycle("OctoMap 5 cm + EDT", kW, 240, 480);
  goals.cycle("OctoMap 5 cm + EDT", kRemoved, 350, 600);
  goals.letter(300, 500);
  return goals.take();
}

}  // namespace depthgrid::lab
