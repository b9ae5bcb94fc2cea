#include "program/distances/robot_pixels.hpp"

#include <algorithm>
#include <cmath>

#include "report/number_text.hpp"

namespace depthgrid::program {

namespace {

RobotPixel kind_of(double reading_m, double near_m, double far_m, bool on_capsules, const SensorMargin& margin) {
  const bool in_span = near_m > 0 && std::isfinite(far_m);
  if (in_span && reading_m > 0 && near_m <= reading_m - depth_margin_m(margin, reading_m) && reading_m <= far_m) {
    return on_capsules ? RobotPixel::removed : RobotPixel::in_padding;
  }
  if (!on_capsules) {
    return RobotPixel::none;
  }
  return !(reading_m > 0)     ? RobotPixel::no_reading
         : reading_m < near_m ? RobotPixel::nearer
         : reading_m <= far_m ? RobotPixel::within_margin
                              : RobotPixel::farther;
}

}  // namespace

void classify_robot_pixels(const DepthImage& measured_m, const RobotView& padded, const RobotView& bare,
                           const SensorMargin& margin, std::vector<RobotPixel>& kinds) {
  const int width_px = measured_m.width_px();
  kinds.assign(measured_m.index(0, measured_m.height_px()), RobotPixel::none);
  if (padded.near_m == nullptr || bare.near_m == nullptr) {
    return;
  }
  const auto stride = [width_px](const RobotView& view) { return view.stride_px == 0 ? width_px : view.stride_px; };
  for (int v = 0; v < measured_m.height_px(); ++v) {
    for (int u = 0; u < width_px; ++u) {
      const std::ptrdiff_t at = v * stride(padded) + u;
      const bool on_capsules = bare.near_m[v * stride(bare) + u] > 0;
      kinds[measured_m.index(u, v)] =
          kind_of(measured_m.at(u, v), padded.near_m[at], padded.far_m[at], on_capsules, margin);
    }
  }
}

void RobotPixelCount::add(std::span<const RobotPixel> kinds) {
  ++images;
  for (const RobotPixel kind : kinds) {
    ++pixels.at(static_cast<std::size_t>(kind));
  }
}

std::int64_t RobotPixelCount::on_capsules() const {
  std::int64_t sum = of(RobotPixel::removed);
  for (const RobotPixel kind :
       {RobotPixel::within_margin, RobotPixel::nearer, RobotPixel::farther, RobotPixel::no_reading}) {
    sum += of(kind);
  }
  return sum;
}

std::string to_text(const RobotPixelCount& count, const std::string& camera) {
  const auto whole = static_cast<double>(count.on_capsules());
  const auto share = [&](RobotPixel kind) { return report::percent_of(static_cast<double>(count.of(kind)), whole); };
  std::string text = "camera '" + camera + "', " + std::to_string(count.images) +
                     (count.images == 1 ? " image: " : " images: ") +
                     report::grouped(count.of(RobotPixel::removed) + count.of(RobotPixel::in_padding)) +
                     " pixels taken for the robot, " + report::grouped(count.of(RobotPixel::in_padding)) +
                     " of them beside its capsules; " + report::grouped(count.on_capsules()) + " show its capsules";
  if (count.on_capsules() == 0) {
    return text;
  }
  text += ": taken " + share(RobotPixel::removed) + ", not because the reading is farther " +
          share(RobotPixel::farther) + ", nearer " + share(RobotPixel::nearer) + ", missing " +
          share(RobotPixel::no_reading);
  if (count.of(RobotPixel::within_margin) > 0) {
    text += ", within the sensor's margin of the padding's front " + share(RobotPixel::within_margin);
  }
  return text;
}

}  // namespace depthgrid::program
