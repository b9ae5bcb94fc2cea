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
- Pixels that the balls before met, asked first: 5 to 10 % slower.
- A look at the pixels around a ball's centre first told 5 % of the noisy balls; 64 % are free. It is gone, a tenth of
  those calls.
- Balls of up to 8 x 8 pixels with columns and rows in one vector: another tenth. Whether any depth of the window is within
  reach, asked first: it told 3 %.

Once balls were quicker, from cubes of twice the size on: 23 % fewer cubes, 39 % more balls, 5 to 10 % slower; from half the
size on: as quick. 64 remembered leaves instead of 32: 3 % quicker with 100 points on noisy images, on W as quick.

Later calls for capsules spent three quarters in distances of cubes from their axes, three projections each, one
waiting for the other. Most cubes are told by their ball or the first plane now: a third less time.

After new images seven
capsules open 7500 cubes (W) or 22 000 (noisy), nearly each of them once: 64 % of the time in boxes, 12 % in what comes
before them and 12 % in distances on W; 40 % in balls, 35 % in boxes on noisy images. Fewer look-ups where the pixels of a
cube are looked up one by one: 5 % less on W. Filled holes (a smallest obstacle of 3 cm) take a quarter off.

Where a cube's pixels lie, for columns and rows in one vector: no gain. The walk in the instruction set of the machine
instead of a call for each cube: 3 % of later calls. The hybrid directions
asked two thirds of their cubes again in every call, which they had found empty: 13 % less on W, 9 % on noisy images; what
is left is the sum over pieces, in double precision and in a certain order.

And on a new image: rows of a dozen buffers cost their address translations, a fifth of the time, until they lay on
large pages. Texels of level 0 from free depths instead of codes: a third slower, loads across cache lines cost more
than a conversion. What is left is memory, some 8 MB an image: the ends of the robot's interval are read where the robot is,
no longer beside it, 5 to 7 % less with a robot.

Free depths written past the caches: no gain without a robot, 5 % slower with
one. Depths and intervals asked for 6 and 8 rows ahead instead of 2 and 4: no gain. Reading where each pixel's interval begins
takes an eighth; whoever makes the intervals could say in which rectangle they are.

On unsynchronised cameras every image still empties what is known. Verdicts kept a camera were tried, with v_max = 0: 86 % of
the cubes that a call looks at were known from the snapshot before, and were asked of the one new camera only.

That gained 4 to 6 % on W and 1 to 2 % on noisy images, for the new image is the one that no cache has, and the nodes
themselves have left the caches by then; asking for nodes ahead gained 1 % and cost later calls 4 %. It was left out. With v_max > 0
the pose error of each camera grows with its age at every snapshot, so that verdicts hold for one snapshot anyway, unless ages
are stepped, which would widen published margins.

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
