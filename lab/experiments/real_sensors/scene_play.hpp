// A scene of a few seconds, played at 30 Hz to one search, and what is asked of it beside the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace depthgrid::experiments {

enum class Scene : std::uint8_t {
  nobody,       ///< the arm moves, the room is empty
  reach,        ///< the arm moves, a person comes, reaches for it and leaves
  hand_behind,  ///< the arm stands, a hand comes to where it hides it from the first camera
};
[[nodiscard]] std::string_view to_string(Scene scene) noexcept;

struct ScenePlay {
  std::string_view sensor;
  int cameras = 2;  ///< simulation::arrangement()
  int width_px = 640;
  Scene scene = Scene::nobody;
  double duration_s = 4;  ///< where nobody plays a script
  std::uint64_t seed = 1;
  /// What is declared for the sensor, a memory that begins with nothing known, a thin layer with the margin in the
  /// test. False: pixels without reading free nothing, the margin is in the padding, nothing is remembered.
  bool declared = false;
};

/// Shares of what was asked, after a first second that only fills the memory.
struct SceneFigures {
  double false_obstacles = 0;  ///< of the nine points' answers: more than 100 mm too near
  double nothing_near = 0;     ///< of those to which nothing is within 0.4 m: that is the answer
  /// Of the instants with the person more than 0.5 m from the arm: each moving link is answered 10 cm or more. NaN: no
  /// such instant.
  double every_link_clear = 0;
  double short_median_m = 0;          ///< truth less answer, of the nine points
  double largest_overestimate_m = 0;  ///< of the nine points while nobody is within the layer of the arm
  std::size_t answers = 0;
};

/// Asked every third image. Throws Error as its parts do.
[[nodiscard]] SceneFigures play(const ScenePlay& scene);

}  // namespace depthgrid::experiments
