#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "lab/speed/number_text.hpp"
#include "lab/speed/page_parts.hpp"
#include "report/markdown_table.hpp"

namespace depthgrid::lab {
namespace {

/// By hand: what no run of the benchmark can find out again.
constexpr const char* kTried =
    R"(What was tried on the calls that take longest, those right after new images, with what it changed:

- A guess from the images before that is exact (the same images again): up to 10 % fewer cubes. What takes the time is
  to show that the space up to the answer is free, not to find it.
- Balls tested from larger cubes on, twice to eight times the pose error: a fifth to two fifths fewer cubes, more balls,
  4 to 33 % slower; from smaller ones on: as quick.

And with the balls:

- A look at the depths of a ball's pixels before the planes through their borders: no gain; most balls seem to
  have pixels that reach into them.
- Pixels that the balls before met, asked first: 5 to 10 % slower. Most balls that meet something seem to be found by
  the look at their centre.

Seven link capsules on noisy images spend 56 % in balls, 33 % in boxes, 10 % in distances. Filled holes (a smallest
obstacle of 3 cm) take a quarter off.

And on a new image: rows of a dozen buffers cost their address translations, a fifth of the time, until they lay on
large pages. Texels of level 0 from free depths instead of codes: a third slower, loads across cache lines cost more
than a conversion. What is left is memory: reading the robot's image takes a seventh of the time with a robot.

On unsynchronised cameras every image still empties what is known; nothing was tried there. With v_max > 0 the pose
error of each camera grows with its age at every snapshot, so that verdicts hold for one snapshot unless ages are
stepped, which would widen published margins; without, verdicts could be kept a camera.

)";

}  // namespace

std::string goals_text(const std::vector<Goal>& all) {
  std::vector<std::string> head{"goal", "bound"};
  for (const WorkloadName& workload : kWorkloadNames) {
    head.insert(head.end(), {workload.title, "met"});
  }
  report::MarkdownTable table(head);
  for (const Goal& goal : all) {
    std::vector<std::string> cells{goal.what, goal.bound_text};
    for (const double value : goal.values) {
      cells.insert(cells.end(), {report::three_digits(value), std::isnan(value) ? ""
                                                              : goal.met(value) ? "yes"
                                                                                : "**MISSED**"});
    }
    table.row(cells);
  }
  const auto missed = std::count_if(all.begin(), all.end(), [](const Goal& goal) { return goal.missed(); });
  std::ostringstream text;
  text << "\n"
       << missed << " of " << all.size() << " are missed on at least one workload.\n\n"
       << table.text() << "\n\n";
  return text.str();
}

std::string goals_text(const std::vector<AimedGoal>& all) {
  report::MarkdownTable table({"goal", "workload", "at most or at least", "aim", "measured", "reached"});
  for (const AimedGoal& goal : all) {
    const std::string bound =
        (goal.aim <= goal.goal ? "<= " : ">= ") + report::three_digits(goal.goal) + ' ' + goal.unit;
    const bool has_aim = goal.aim != goal.goal;
    table.row({goal.what, goal.workload, bound, has_aim ? report::three_digits(goal.aim) : "-",
               report::three_digits(goal.value),
               std::isnan(goal.value)              ? ""
               : !goal.reached(goal.goal)          ? "**missed**"
               : has_aim && goal.reached(goal.aim) ? "aim"
                                                   : "goal"});
  }
  const auto missed = std::count_if(all.begin(), all.end(), [](const AimedGoal& goal) {
    return !std::isnan(goal.value) && !goal.reached(goal.goal);
  });
  std::ostringstream text;
  text << "\nSet once verdicts were kept from call to call, with an aim beyond each; two cameras, medians where no "
          "mean is "
          "named. "
       << missed << " of " << all.size() << " are missed.\n\n"
       << table.text() << "\n";
  return text.str();
}

void write_work(std::ostream& page, const Report& report) {
  page
      << "## Where the time goes\n\nWhat one call does, in cubes of the octree that it opens and exact tests of a ball "
         "against one camera:\n\n";
  report::MarkdownTable table({"question", "workload", "cameras", "µs (mean)", "cubes", "ball tests", "ns a cube"});
  for (const auto& [workload, title] : kWorkloadNames) {
    for (const Record* row : report.group(std::string("ours, ") + workload)) {
      const double nodes = (*row)["nodes_mean"];
      const double cameras = (*row)["cameras"];
      if (std::isfinite(nodes) && (cameras == 2 || cameras == 8)) {
        table.row({row->name, workload, whole(cameras), microseconds((*row)["call_mean_s"]), whole(nodes),
                   whole((*row)["ball_tests_mean"]), report::three_digits(1e9 * (*row)["call_mean_s"] / nodes)});
      }
    }
  }
  page << table.text() << "\n\n" << kTried;
}

}  // namespace depthgrid::lab
