#include "program/distances/least_padding.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "depthgrid/avoidance/least_padding.hpp"
#include "depthgrid/core/error.hpp"
#include "report/number_text.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::program {

namespace {

/// Images of many frames, of which a recording holds one.
class KeptImages {
 public:
  /// The same frame on pixels of its own.
  Frame keep(const Frame& frame) {
    Frame kept = frame;
    const std::ptrdiff_t row = row_bytes(frame.depth.format, frame.depth.width_px);
    std::vector<std::byte>& pixels = images_.emplace_back(static_cast<std::size_t>(row * frame.depth.height_px));
    for (int v = 0; v < frame.depth.height_px; ++v) {
      std::memcpy(pixels.data() + row * v,
                  static_cast<const std::byte*>(frame.depth.data) + frame.depth.stride_bytes * v,
                  static_cast<std::size_t>(row));
    }
    kept.depth.data = pixels.data();
    kept.depth.stride_bytes = row;
    kept.robot = {};
    return kept;
  }

 private:
  std::vector<std::vector<std::byte>> images_;
};

}  // namespace

std::string least_padding_text(DistancesPlan& plan) {
  KeptImages kept;
  std::vector<avoidance::EmptyCell> cells;
  report::ProgressLine progress("frame", plan.frames.size());
  for (const int index : plan.frames) {
    const std::span<const Frame> frames =
        plan.robot->frames(plan.recording.frame_number(index), plan.recording.read(index), plan.rig);
    avoidance::EmptyCell& cell = cells.emplace_back();
    for (const Frame& frame : frames) {
      cell.seen.push_back(kept.keep(frame));
    }
    cell.T_world_link = plan.robot->T_world_link();
    cell.motion_m = plan.robot->motion_m();
    progress.update(cells.size());
  }
  if (!plan.robot->is_in_an_image()) {
    fail("the robot's capsules are in no image of these frames, so they say nothing of its padding; is --base right?");
  }
  const avoidance::LeastPadding found =
      avoidance::least_padding(plan.rig, plan.robot->model(), cells, *plan.least_padding);
  std::string text = to_string(found, plan.rig, plan.T_output_world);
  const auto unclear = std::count_if(found.links.begin(), found.links.end(),
                                     [](const avoidance::LinkPadding& link) { return !link.least_m; });
  if (unclear > 0) {
    text += "State no padding by this: " + std::to_string(unclear) + " of " + std::to_string(found.links.size()) +
            " links are not clear with any that was tested.\n";
  } else if (found.padding_m) {
    text += "So state --robot-padding " + report::fixed(*found.padding_m, 3) + "\n";
  }
  return text;
}

}  // namespace depthgrid::program
