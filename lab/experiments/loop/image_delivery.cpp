#include "lab/experiments/loop/image_delivery.hpp"

#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::experiments {

ImageDelivery::ImageDelivery(const Rig& rig, const robot::RobotModel& model, const robot::JointHistory& history,
                             AvoidanceCell& cell, DistanceEvaluator& evaluator, const AvoidanceSettings& settings,
                             std::uint64_t seed, OnFrame on_frame)
    : rig_(rig),
      cell_(cell),
      evaluator_(evaluator),
      settings_(settings),
      on_frame_(std::move(on_frame)),
      intake_(rig, {model}, history, exposure_settings(settings)),
      sensors_(rig, {.seed = seed}) {}

void ImageDelivery::expose(double time_s) {
  cell_.render(rig_, ideal_m_);
  Exposure exposure{time_s, {}};
  if (settings_.sensor == "ideal") {
    exposure.measured_m = ideal_m_;
  } else {
    exposure.measured_m.resize(ideal_m_.size());
    sensors_.measure(ideal_m_, frame_number_, exposure.measured_m);
  }
  ++frame_number_;
  if (on_frame_) {
    on_frame_(time_s, exposure.measured_m);
  }
  on_the_way_.push_back(std::move(exposure));
}

void ImageDelivery::deliver(double time_s) {
  while (!on_the_way_.empty() && on_the_way_.front().time_s + settings_.frame_latency_s <= time_s + 1e-9) {
    const Exposure& exposure = on_the_way_.front();
    std::vector<Frame> seen;
    for (const DepthImage& image : exposure.measured_m) {
      seen.push_back({depth_view(image), {}, exposure.time_s});
    }
    if (const FrameUpdate update = update_all(evaluator_, intake_.frames(seen)); !update.taken()) {
      fail("simulated run: the images of ", exposure.time_s, " s are not taken: ", update.reason);
    }
    on_the_way_.pop_front();
  }
}

}  // namespace depthgrid::experiments
