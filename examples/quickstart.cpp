// Quick start: depth images from your own driver in, distances of robot links out, with threads. No file, no allocation
// in the loop. With one thread SearchEvaluator does what store and search do here (evaluator_quickstart.cpp).
//
//   c++ -std=c++20 -O2 quickstart.cpp $(pkg-config --cflags --libs depthgrid_search)
//
// or examples/consumer for CMake; docs/search.md says more about both.
//
// Ownership  depth_view() and Frame never copy and never own: your buffer must outlive the call of update() and must
//            not change during it. update() takes what it needs, so that afterwards the buffer is yours again.
// Stride     is in bytes from one row to the next, so padded and cropped images need no copy; 0 means no padding.
// Threads    one thread a camera may call update(), and any number of threads may ask at the same time, each with its
//            own Search. A snapshot stays as it is while images arrive; drop it when the answers are read.
// Errors     construction and depth_view() throw depthgrid::Error; update(), snapshot() and distances() are noexcept,
//            allocate nothing and take no lock. What could not be answered has a state that says so.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/search/search.hpp"

namespace search = depthgrid::search;
namespace views = depthgrid::views;

namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr int kRowPixels = 704;  // the driver pads its rows; their bytes are the stride
constexpr std::ptrdiff_t kStrideBytes = kRowPixels * std::ptrdiff_t{sizeof(std::uint16_t)};

// Stands for your camera driver: a wall at 2.5 m and a box of 40 cm in front of it, in millimetres.
std::vector<std::uint16_t> image_from_driver() {
  std::vector<std::uint16_t> pixels(std::size_t{kRowPixels} * kHeight, 2500);
  for (std::size_t v = 180; v < 300; ++v) {
    for (std::size_t u = 260; u < 380; ++u) {
      pixels[v * kRowPixels + u] = 1600;
    }
  }
  return pixels;
}

int run() {
  // 1. The rig: intrinsics as OpenCV or ROS give them, the pose that maps camera to world coordinates (metres; camera
  //    frame x right, y down, z forward), and how far the camera may err. Add cameras for space that the first cannot
  //    see; they need no common image size, rate or sensor.
  const depthgrid::SensorModel& sensor = depthgrid::sensor_model("realsense_d435");
  depthgrid::Rig rig;
  depthgrid::RigCamera& camera = rig.cameras.emplace_back();
  camera.id = "front";
  camera.intrinsics = depthgrid::from_opencv(kWidth, kHeight, 525.0, 525.0, 319.5, 239.5);
  camera.T_world_camera = depthgrid::look_at({0.0, 0.0, 1.0}, {1.0, 0.0, 1.0});
  camera.metres_per_unit = 0.001;
  camera.rule = sensor.rule;  // readings outside 0.28 ... 3 m are no measurements
  camera.margins = depthgrid::sensor_margins(sensor, camera.intrinsics, camera.metres_per_unit);
  camera.margins->translation_m = 0.005;                             // calibration: where the camera stands
  camera.margins->rotation_rad = 0.002;                              // and looks
  camera.margins->smallest_obstacle_m = sensor.smallest_obstacle_m;  // what is smaller may be missed

  // 2. What counts as an obstacle. None of this has a default.
  views::Settings settings;
  settings.space = views::BoxSpace{{0.3, -1.0, 0.2}, {2.4, 1.0, 1.9}};
  settings.policies.unobserved = views::Policy::obstacle;     // what no camera looks at
  settings.policies.outside = views::Policy::ignored;         // beyond the box: known_to_m says how far it is
  settings.policies.robot_pockets = views::Policy::obstacle;  // the shadow right behind the robot
  settings.margins = depthgrid::camera_margins(rig);
  settings.v_max_m_s = 1.6;  // nothing moves faster
  settings.rho_m = 0.6;      // how far around a link obstacles matter

  // 3. Every buffer is allocated here.
  views::ViewStore store(rig, settings);
  search::Search search;

  // 4. For every exposure of every camera, as it comes. A camera that moves gives its pose with the image.
  const std::vector<std::uint16_t> pixels = image_from_driver();
  depthgrid::Frame frame;
  frame.depth = depthgrid::depth_view(pixels, kWidth, kHeight, camera.metres_per_unit, kStrideBytes);
  frame.time_s = 0.0;  // middle of the exposure, one clock for all cameras
  if (const depthgrid::FrameUpdate update = store.update(0, frame); !update.taken()) {
    std::printf("frame not taken: %s\n", update.reason);
  }

  // 5. Whole links of the robot at once: points, spheres and capsules, world frame.
  const std::array<depthgrid::Capsule, 3> links = {depthgrid::Capsule{{0.7, 0.0, 0.9}, {1.0, 0.0, 1.0}, 0.06},
                                                   depthgrid::Capsule::sphere({1.1, 0.0, 1.0}, 0.08),
                                                   depthgrid::Capsule::point({1.9, 0.0, 1.0})};
  std::array<depthgrid::Answer, 3> answers;
  search.distances(store.snapshot(), links, answers);
  for (const depthgrid::Answer& answer : answers) {
    const auto state = depthgrid::to_string(answer.nearest.state);
    std::printf("%.3f m  %.*s, known to %.3f m\n", answer.nearest.distance_m, static_cast<int>(state.size()),
                state.data(), answer.nearest.known_to_m);
  }
  return 0;
}

}  // namespace

int main() try { return run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
