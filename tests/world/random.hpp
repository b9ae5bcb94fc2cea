// Random numbers of the worlds: the same with every standard library, and a stream of its own for every purpose, so
// that a world does not change when another part of it is drawn otherwise.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace depthgrid::world {

class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : state_(mixed(seed) ^ mixed(stream * 0xD1342543DE82EF95U + 1)) {}

  /// In [low, high).
  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11U) * 0x1p-53;
  }
  /// Inclusive.
  [[nodiscard]] int integer(int low, int high) {
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  [[nodiscard]] bool chance(double probability) { return uniform(0, 1) < probability; }
  [[nodiscard]] Eigen::Vector3d in_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const double x = uniform(low.x(), high.x());
    const double y = uniform(low.y(), high.y());
    return {x, y, uniform(low.z(), high.z())};
  }
  /// Of length 1.
  [[nodiscard]] Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d v = in_box(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1));
      if (v.norm() > 0.1 && v.norm() < 1) {
        return v.normalized();
      }
    }
  }

 private:
  [[nodiscard]] static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  [[nodiscard]] std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15U;
    return mixed(state_);
  }

  std::uint64_t state_;
};

}  // namespace depthgrid::world
