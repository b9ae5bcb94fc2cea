#include "lab/experiments/blind_layer/self_filter.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/stage/rig_width.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"
#include "report/plot.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kTooFar_m = 0.01;
constexpr double kSweepEnd_m = 0.40;
constexpr std::array kPlaces{HandPlace::beside, HandPlace::before};

/// The pixels of one image as points, with what the rules ask of them.
struct SeenPoint {
  double to_link_m = 0;   ///< from the last link's surface
  double to_robot_m = 0;  ///< from the nearest link's
  bool hand = false;
  std::size_t pixel = 0;
};

std::vector<SeenPoint> seen_points(const HandBeside& scene, std::size_t camera) {
  const RigCamera& c = scene.rig().cameras[camera];
  const DepthImage& image = scene.depth_m(camera);
  std::vector<SeenPoint> points;
  for (int v = 0; v < image.height_px(); ++v) {
    for (int u = 0; u < image.width_px(); ++u) {
      if (image.at(u, v) <= 0) {
        continue;
      }
      const Eigen::Vector3d p_world = c.T_world_camera * deproject(c.intrinsics, {u + 0.5, v + 0.5, image.at(u, v)});
      SeenPoint point;
      point.pixel = image.index(u, v);
      point.hand = scene.shows_hand(camera, point.pixel);
      point.to_link_m = distance_to_axis(scene.link_world(), p_world) - scene.link_world().radius_m;
      point.to_robot_m = std::numeric_limits<double>::infinity();
      for (const Capsule& link : scene.arm().capsules_world()) {
        point.to_robot_m = std::min(point.to_robot_m, distance_to_axis(link, p_world) - link.radius_m);
      }
      points.push_back(point);
    }
  }
  return points;
}

/// Of one image, one a pixel: whether the padded robot stands in it.
std::vector<bool> mask_of(const HandBeside& scene, std::size_t camera, double padding_m) {
  const RigCamera& c = scene.rig().cameras[camera];
  robot::RobotRemoval removal(c.intrinsics, scene.arm().capsules(), {padding_m, true});
  const RobotView view = removal.find(scene.arm().T_world_link(), c.T_world_camera);
  std::vector<bool> mask;
  for (int v = 0; v < c.intrinsics.height_px; ++v) {
    for (int u = 0; u < c.intrinsics.width_px; ++u) {
      mask.push_back(view.near_m[view.stride_px * v + u] > 0);
    }
  }
  return mask;
}

/// The nearest point that is left: what nobody sees counts as free.
FilterReading without(const std::vector<std::vector<SeenPoint>>& images, const HandBeside& scene,
                      const FilterRule& rule) {
  FilterReading reading;
  reading.distance_m = kFarthest_m;
  for (std::size_t k = 0; k < images.size(); ++k) {
    const std::vector<bool> mask =
        rule.filter == SelfFilter::masked ? mask_of(scene, k, rule.distance_m) : std::vector<bool>{};
    for (const SeenPoint& point : images[k]) {
      const bool left = mask.empty() ? point.to_robot_m > rule.distance_m : !mask[point.pixel];
      if (left) {
        reading.distance_m = std::min(reading.distance_m, std::max(0.0, point.to_link_m));
        reading.hand_px += point.hand ? 1 : 0;
      }
    }
  }
  return reading;
}

/// How many pixels of the hand our removal leaves: their reading is not the robot's.
std::size_t hand_left(const HandBeside& scene, double padding_m) {
  std::size_t left = 0;
  for (std::size_t k = 0; k < scene.rig().cameras.size(); ++k) {
    const RigCamera& c = scene.rig().cameras[k];
    const DepthImage& image = scene.depth_m(k);
    robot::RobotRemoval removal(c.intrinsics, scene.arm().capsules(), {padding_m, true});
    const DepthView depth = depth_view(image);
    const RobotView view = removal.find(scene.arm().T_world_link(), c.T_world_camera, {}, &depth);
    for (int v = 0; v < image.height_px(); ++v) {
      for (int u = 0; u < image.width_px(); ++u) {
        const std::ptrdiff_t at = view.stride_px * v + u;
        const bool robot = view.near_m[at] > 0 && image.at(u, v) >= view.near_m[at] && image.at(u, v) <= view.far_m[at];
        left += scene.shows_hand(k, image.index(u, v)) && !robot ? 1 : 0;
      }
    }
  }
  return left;
}

std::string metres(const std::optional<double>& value_m) {
  return !value_m ? "never" : *value_m > kSweepEnd_m - 0.5 * kTooFar_m ? "all" : "up to " + report::fixed(*value_m, 2);
}

template <class Is>
std::optional<double> largest_gap(const std::vector<FilterReading>& readings, Is&& is) {
  std::optional<double> largest_m;
  for (const FilterReading& reading : readings) {
    largest_m = is(reading) ? std::optional(reading.gap_m) : largest_m;
  }
  return largest_m;
}

bool too_far(const FilterReading& reading) { return reading.distance_m > reading.gap_m + kTooFar_m; }

report::Canvas draw_sweeps(const std::vector<FilterSweep>& sweeps) {
  report::Canvas canvas(1000, 680);
  double y_px = 6;
  for (const HandPlace place : kPlaces) {
    report::Plot plot{place == HandPlace::beside ? "a hand beside the link" : "a hand between camera 1 and the link",
                      "really (m)",
                      "answered (m)",
                      false,
                      false,
                      {}};
    report::Series truth{"truth", {0, kSweepEnd_m}, {0, kSweepEnd_m}, false, true};
    plot.series.push_back(truth);
    for (const FilterSweep& sweep : sweeps) {
      const FilterRule& rule = filter_rules()[sweep.rule];
      if (sweep.place != place || rule.distance_m == 0.1) {
        continue;
      }
      report::Series series{rule.label, {}, {}, false, true};
      for (const FilterReading& reading : sweep.readings) {
        series.x.push_back(reading.gap_m);
        series.y.push_back(reading.distance_m);
      }
      plot.series.push_back(series);
    }
    draw_plot(canvas, {6, y_px, 988, 330}, plot);
    y_px += 336;
  }
  return canvas;
}

}  // namespace

const std::vector<FilterRule>& filter_rules() {
  static const std::vector<FilterRule> rules = [] {
    std::vector<FilterRule> all;
    for (const double distance_m : {0.05, 0.10, 0.20}) {
      all.push_back({"deleted within " + report::fixed(distance_m, 2) + " m", SelfFilter::deleted, distance_m});
    }
    for (const double distance_m : {0.05, 0.10, 0.20}) {
      all.push_back({"masked, padding " + report::fixed(distance_m, 2) + " m", SelfFilter::masked, distance_m});
    }
    for (const double distance_m : {0.05, 0.10, 0.20}) {
      all.push_back({"removed, padding " + report::fixed(distance_m, 2) + " m", SelfFilter::removed, distance_m});
    }
    return all;
  }();
  return rules;
}

std::optional<double> FilterSweep::gone_to_m() const {
  return largest_gap(readings, [](const FilterReading& r) { return r.hand_px == 0; });
}
std::optional<double> FilterSweep::too_far_to_m() const { return largest_gap(readings, too_far); }
std::optional<double> FilterSweep::unsaid_to_m() const {
  return largest_gap(readings, [](const FilterReading& r) { return too_far(r) && r.to_robot_m > r.blind_m; });
}
double FilterSweep::most_too_far_m() const {
  double most_m = 0;
  for (const FilterReading& reading : readings) {
    most_m = std::max(most_m, reading.distance_m - reading.gap_m);
  }
  return most_m;
}

std::vector<FilterSweep> measure_self_filter(const Options& options, ExperimentReport* pictures) {
  HandBeside scene(with_width(simulation::letter_arrangement("ideal").rig, width_or(options, 640, 160)), options.seed);
  const int steps = frames_or(options, 40, 20);
  std::vector<FilterSweep> sweeps;
  for (const HandPlace place : kPlaces) {
    for (std::size_t rule = 0; rule < filter_rules().size(); ++rule) {
      sweeps.push_back({rule, place, {}});
    }
  }
  for (std::size_t p = 0; p < kPlaces.size(); ++p) {
    for (int step = 0; step <= steps; ++step) {
      const double gap_m = kSweepEnd_m * step / steps;
      scene.take(kPlaces[p], gap_m);
      std::vector<std::vector<SeenPoint>> images;
      for (std::size_t k = 0; k < scene.rig().cameras.size(); ++k) {
        images.push_back(seen_points(scene, k));
      }
      for (std::size_t r = 0; r < filter_rules().size(); ++r) {
        const FilterRule& rule = filter_rules()[r];
        FilterReading reading;
        if (rule.filter == SelfFilter::removed) {
          const Answer answer = removed_answer(scene, rule.distance_m);
          reading.distance_m = answer.nearest.distance_m;
          reading.blind_m = answer.blind_m;
          reading.hand_px = hand_left(scene, rule.distance_m);
        } else {
          reading = without(images, scene, rule);
        }
        reading.gap_m = gap_m;
        reading.to_robot_m = std::numeric_limits<double>::infinity();
        for (const Capsule& link : scene.arm().capsules_world()) {
          const double to_link_m = distance_to_axis(link, scene.hand_world()) - link.radius_m - kHandRadius_m;
          reading.to_robot_m = std::min(reading.to_robot_m, to_link_m);
        }
        sweeps[p * filter_rules().size() + r].readings.push_back(reading);
      }
      options.progress(p * static_cast<std::size_t>(steps + 1) + static_cast<std::size_t>(step) + 1,
                       kPlaces.size() * static_cast<std::size_t>(steps + 1));
    }
  }
  if (pictures != nullptr) {
    pictures->picture("self-filter.png", draw_sweeps(sweeps),
                      "The distance that each rule answers for the link, as the hand comes nearer; 0.6 m: nothing.");
  }
  return sweeps;
}

void run_self_filter(const Options& options, ExperimentReport& report) {
  report.paragraph(
      "The same arm, cameras and ball, ideal sensors, the ball from 0.4 m to contact, beside the link and between "
      "camera 1 and the link. *Deleted*: every pixel whose point lies within a distance of the robot's capsules is "
      "taken out, and what nobody sees counts as free: the nearest point left is the answer. *Masked*: the same with "
      "all pixels in which the padded robot would stand. *Removed*: this project's. Up to which distance from the link "
      "no pixel of the ball is left, and up to which the answer is more than 1 cm too far:");
  const std::vector<FilterSweep> sweeps = measure_self_filter(options, &report);
  report::MarkdownTable table(
      {"rule", "hand", "no pixel of it left", "answer too far", "most", "at 0.02 m it answers", "and says blind_m"});
  for (const FilterSweep& sweep : sweeps) {
    const FilterRule& rule = filter_rules()[sweep.rule];
    const char* place = sweep.place == HandPlace::beside ? "beside" : "before";
    const auto near = std::min_element(sweep.readings.begin(), sweep.readings.end(),
                                       [](const FilterReading& a, const FilterReading& b) {
                                         return std::abs(a.gap_m - 0.02) < std::abs(b.gap_m - 0.02);
                                       });
    table.row({rule.label, place, metres(sweep.gone_to_m()), metres(sweep.too_far_to_m()),
               report::fixed(sweep.most_too_far_m(), 2) + " m",
               near->distance_m >= kFarthest_m ? "nothing" : report::fixed(near->distance_m, 3) + " m",
               rule.filter == SelfFilter::removed ? report::fixed(near->blind_m, 3) : "-"});
    auto& json = report.figures()[place][rule.label];
    const auto number = [](const std::optional<double>& value) {
      return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    };
    json["no_pixel_left_to_m"] = number(sweep.gone_to_m());
    json["too_far_to_m"] = number(sweep.too_far_to_m());
    json["too_far_and_not_said_to_m"] = number(sweep.unsaid_to_m());
    json["most_too_far_m"] = sweep.most_too_far_m();
    for (const FilterReading& reading : sweep.readings) {
      json["gap_m"].push_back(reading.gap_m);
      json["distance_m"].push_back(reading.distance_m);
      json["blind_m"].push_back(reading.blind_m);
      json["hand_px"].push_back(reading.hand_px);
    }
  }
  report.paragraph(table.text());
  const auto unsaid = [&](SelfFilter filter) {
    double most_m = 0;
    for (const FilterSweep& sweep : sweeps) {
      most_m = filter_rules()[sweep.rule].filter == filter ? std::max(most_m, sweep.unsaid_to_m().value_or(0)) : most_m;
    }
    return report::fixed(most_m, 2) + " m";
  };
  report.headline("Answers that are too far without saying so: deleted, with the hand as far as " +
                  unsaid(SelfFilter::deleted) + " from the link; masked, " + unsaid(SelfFilter::masked) +
                  "; removed, " + unsaid(SelfFilter::removed) + ".");
}

}  // namespace depthgrid::experiments
