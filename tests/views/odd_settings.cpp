#include "views/odd_settings.hpp"

#include <bit>
#include <random>

namespace depthgrid::views {
namespace {

constexpr int kCount = 8;

/// Any bits at all, and those that are easily got wrong.
class Odd {
 public:
  explicit Odd(std::uint64_t seed) : engine_(seed) {}
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  double number() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::vector<double> special{0.0, -0.0,      1.0,        -1.0,
                                      0.1, 1e22,      1e300,      1e-320,
                                      2e5, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()};
    const auto i = static_cast<std::size_t>(integer(0, 2 * static_cast<int>(special.size())));
    return i < special.size() ? special[i] : std::bit_cast<double>(engine_());
  }
  Eigen::Vector3d vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }
  Pose pose() {
    Pose pose;
    for (int i = 0; i < 16; ++i) {
      pose.matrix()(i / 4, i % 4) = number();
    }
    return pose;
  }
  std::string text() {
    std::string text;
    const bool plain = integer(0, 1) == 0;
    for (int i = integer(0, 12); i > 0; --i) {
      text += static_cast<char>(plain ? integer(' ', '~') : integer(0, 255));
    }
    return text;
  }
  CameraMargins margins() {
    CameraMargins m;
    m.sensor = {number(), number(), number(), integer(-3, 20)};
    m.translation_m = number();
    m.rotation_rad = number();
    m.half_exposure_s = number();
    m.time_uncertainty_s = number();
    m.smallest_obstacle_m = number();
    m.second_view_x_m = number();
    return m;
  }
  Policies policies() {
    const auto policy = [this] { return static_cast<Policy>(integer(0, 3)); };
    return {policy(), policy(), policy(), number()};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace

std::vector<Rig> odd_rigs() {
  std::vector<Rig> rigs;
  for (std::uint64_t seed = 0; seed < kCount; ++seed) {
    Odd odd(seed);
    Rig rig;
    rig.name = odd.text();
    for (int k = odd.integer(0, 3); k > 0; --k) {
      RigCamera camera;
      camera.id = odd.text();
      camera.intrinsics = {odd.integer(-1, 999), odd.integer(-1, 999), odd.number(),
                           odd.number(),         odd.number(),         odd.number()};
      camera.distortion.model = static_cast<Distortion::Model>(odd.integer(0, 3));
      for (double& coefficient : camera.distortion.coefficients) {
        coefficient = odd.number();
      }
      camera.metres_per_unit = odd.number();
      camera.rule = {odd.number(), odd.number(), odd.integer(0, 1) == 1, {}};
      for (int i = odd.integer(0, 3); i > 0; --i) {
        camera.rule.invalid_units.push_back(static_cast<std::uint16_t>(odd.integer(0, 65535)));
      }
      camera.T_world_camera = odd.pose();
      camera.sensor = odd.text();
      if (odd.integer(0, 1) == 1) {
        camera.margins = odd.margins();
      }
      rig.cameras.push_back(camera);
    }
    if (odd.integer(0, 1) == 1) {
      rig.T_floor_world = odd.pose();
    }
    rigs.push_back(rig);
  }
  return rigs;
}

std::vector<Settings> odd_settings() {
  std::vector<Settings> all{Settings{}};
  for (std::uint64_t seed = 1; seed < kCount; ++seed) {
    Odd odd(seed);
    Settings s;
    if (const int kind = odd.integer(0, 2); kind == 1) {
      s.space = FrustumSpace{static_cast<std::size_t>(odd.integer(0, 9)), odd.number(), odd.number()};
    } else if (kind == 2) {
      s.space = BoxSpace{odd.vector(), odd.vector()};
    }
    s.policies = odd.policies();
    for (int k = odd.integer(0, 3); k > 0; --k) {
      s.margins.push_back(odd.margins());
    }
    s.rho_m = odd.number();
    s.resolution_m = odd.number();
    if (odd.integer(0, 1) == 1) {
      s.v_max_m_s = odd.number();
    }
    s.max_frame_age_s = odd.number();
    s.direction_blend = odd.number();
    s.repulsion_alpha = odd.number();
    all.push_back(s);
  }
  return all;
}

}  // namespace depthgrid::views
