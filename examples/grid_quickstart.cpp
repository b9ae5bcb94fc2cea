// Quick start of the depth grid, the letter's method: as quickstart.cpp, with the grid's evaluator. One camera spans
// the grid and sees all space of interest, the cameras stand still, and the answers are for points.
//
//   c++ -std=c++20 grid_quickstart.cpp $(the flags of depthgrid::grid)     or see examples/consumer for CMake
//
// Ownership  depth_view() and Frame never copy and never own: your buffer must outlive the call of update() and must
//            not change during it. update() takes what it needs, so that afterwards the buffer is yours again.
// Stride     is in bytes from one row to the next, so padded and cropped images need no copy; 0 means no padding.
// Threads    update() is for one thread at a time. evaluate() may run in any number of threads at once, but not while
//            update() runs on the same evaluator. Two evaluators share nothing.
// Errors     construction and depth_view() throw depthgrid::Error; update() and evaluate() are noexcept, allocate
//            nothing and take no lock. What could not be answered has a state that says so, never a magic number.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"

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
  // 1. The rig: intrinsics as OpenCV or ROS give them, and the pose that maps camera to world coordinates (metres;
  //    camera frame x right, y down, z forward). Add further cameras for space that the first cannot see.
  depthgrid::Rig rig;
  depthgrid::RigCamera& camera = rig.cameras.emplace_back();
  camera.id = "front";
  camera.intrinsics = depthgrid::from_opencv(kWidth, kHeight, 525.0, 525.0, 319.5, 239.5);
  camera.T_world_camera = depthgrid::look_at({0.0, 0.0, 1.0}, {1.0, 0.0, 1.0});
  camera.metres_per_unit = 0.001;
  camera.rule.near_m = 0.4;  // nothing nearer is believed
  camera.rule.far_m = 6.0;

  // 2. The evaluator: every buffer is allocated here. Depth cells of 1 cm from 0.3 m to 4.3 m: they
  //    begin before near_m, so that the blind zone counts as unseen space and is not left out.
  depthgrid::grid::DepthQuantisation quantisation;
  quantisation.d_min_m = 0.3;
  quantisation.step_m = 0.01;
  quantisation.count = 400;
  depthgrid::grid::EvaluationSettings settings;
  settings.rho_m = 0.6;                // how far around a point obstacles matter
  settings.sensor.constant_m = 0.005;  // what your sensor's depth may be off by
  settings.sensor.quadratic_per_m = 0.002;
  depthgrid::grid::GridEvaluator evaluator(rig, 0, quantisation, settings);

  // 3. For every exposure of every camera. The view is on your buffer.
  const std::vector<std::uint16_t> pixels = image_from_driver();
  depthgrid::Frame frame;
  frame.depth = depthgrid::depth_view(pixels, kWidth, kHeight, camera.metres_per_unit, kStrideBytes);
  frame.time_s = 0.0;  // middle of the exposure, one clock for all cameras
  if (const depthgrid::FrameUpdate update = evaluator.update(0, frame); !update.taken()) {
    std::printf("no usable frame, all the camera should see counts as not known free: %s\n", update.reason);
  }

  // 4. Any number of points on the robot, world frame.
  for (const Eigen::Vector3d& p_world :
       {Eigen::Vector3d{1.3, 0.0, 1.0}, Eigen::Vector3d{1.9, 0.0, 1.0}, Eigen::Vector3d{1.2, 0.5, 1.2}}) {
    const depthgrid::Proximity answer = evaluator.distance(depthgrid::Capsule::point(p_world)).nearest;
    const auto state = depthgrid::to_string(answer.state);
    std::printf("(%.2f %.2f %.2f)  %.3f m  %.*s\n", p_world.x(), p_world.y(), p_world.z(), answer.distance_m,
                static_cast<int>(state.size()), state.data());
  }
  return 0;
}

}  // namespace

int main() try { return run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
