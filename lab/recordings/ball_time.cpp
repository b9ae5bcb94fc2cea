#include "lab/recordings/ball_time.hpp"

#include <random>
#include <vector>

#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/search/search.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/recordings/ball_search.hpp"
#include "lab/recordings/ball_study.hpp"
#include "lab/recordings/margin_settings.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"

namespace depthgrid::lab {
namespace {

constexpr int kLaterCalls = 10;
constexpr double kStep_m = 0.02;

struct Times {
  Samples images_s;
  Samples first_s;
  Samples later_s;
};

/// Nine of the fourteen directions, 0.4 m from the ball's centre.
std::vector<Capsule> nine_around(const Eigen::Vector3d& centre, const Eigen::Vector3d& shift) {
  const std::vector<Eigen::Vector3d> points = points_around(centre);
  std::vector<Capsule> nine;
  for (std::size_t i = 0; i < 9; ++i) {
    nine.push_back(Capsule::point(points[3 * i + 1] + shift));
  }
  return nine;
}

Times times_of(files::Recording& recording, const BallTrack& track, double smallest_obstacle_m) {
  const Rig rig = ball_rig(recording);
  CameraMargins margins;
  margins.sensor = sensor_model("kinect_v1").margin;
  margins.translation_m = 0.02;
  margins.rotation_rad = 0.009;
  margins.smallest_obstacle_m = smallest_obstacle_m;
  views::ViewStore store(rig, ball_search_settings(std::vector(rig.cameras.size(), margins), 0));
  search::Search search;
  std::mt19937_64 generator(1);
  const auto step_m = [&generator] { return kStep_m * (static_cast<double>(generator() >> 11U) * 0x1p-52 - 1); };
  const Pose T_floor_world = recording.rig().T_floor_world.value_or(Pose::Identity());
  Times times;
  for (int frame = 0; frame < recording.frame_count(); ++frame) {
    const auto tracked = track.centre_world.find(recording.frame_number(frame));
    if (tracked == track.centre_world.end()) {
      continue;
    }
    const auto images = recording.read(frame);
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      times.images_s.add(timed_s([&] { (void)store.update(k, images[k]); }));
    }
    const views::Snapshot snapshot = store.snapshot();
    for (int call = 0; call <= kLaterCalls; ++call) {
      const double x = step_m();
      const double y = step_m();
      const std::vector<Capsule> points = nine_around(T_floor_world * tracked->second, {x, y, step_m()});
      std::vector<Answer> answers(points.size());
      Samples& samples = call == 0 ? times.first_s : times.later_s;
      samples.add(timed_s([&] { search.distances(snapshot, points, answers); }));
    }
  }
  return times;
}

std::string milliseconds(double time_s) { return report::three_digits(1e3 * time_s); }

}  // namespace

std::string ball_time_table(files::Recording& recording, const BallTrack& track) {
  report::MarkdownTable table(
      {"s", "frames", "image in, ms", "first call, median", "worst", "later calls, median", "worst"});
  for (const double smallest_obstacle_m : {0.0, 0.05}) {
    const Times t = times_of(recording, track, smallest_obstacle_m);
    table.row({report::three_digits(100 * smallest_obstacle_m) + " cm", std::to_string(t.first_s.count()),
               milliseconds(t.images_s.median()), milliseconds(t.first_s.median()), milliseconds(t.first_s.largest()),
               milliseconds(t.later_s.median()), milliseconds(t.later_s.largest())});
  }
  return table.text();
}

}  // namespace depthgrid::lab
