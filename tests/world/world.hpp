// A world with a truth: things that move at most so fast and are at least so thick, a robot, and the cameras that look.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/memory/settings.hpp"
#include "depthgrid/views/settings.hpp"
#include "world/geometry.hpp"
#include "world/motion.hpp"

namespace depthgrid::world {

/// One assumption that a world breaks on purpose.
enum class Broken : std::uint8_t {
  none,
  faster,    ///< things move 1.5 to 4 times as fast as declared
  thinner,   ///< things are thinner than a pixel and than declared
  black,     ///< so are some of them, and these give no reading
  clear,     ///< cameras see what is behind some things
  dropped,   ///< something is suddenly there
  clock,     ///< one camera's clock is off by more than declared
  pose,      ///< one camera stands elsewhere by more than declared
  readings,  ///< readings are too far by more than their margins
};
inline constexpr std::size_t kBroken = 9;
[[nodiscard]] const char* to_string(Broken broken);
[[nodiscard]] std::vector<std::string> broken_names();
/// Throws Error when no assumption is called so.
[[nodiscard]] Broken broken_of(const std::string& name);

struct WorldOptions {
  std::uint64_t seed = 1;
  int width_px = 0;  ///< of all images; 0: 40 to 96, by the seed
  Broken broken = Broken::none;
  bool memory = false;    ///< the search remembers
  bool smallest = false;  ///< the smallest obstacle is declared
};
/// What plays the world again, for depthgrid-lab worlds: "--world 17 --broken clock". The second reads it; throws
/// Error.
[[nodiscard]] std::string command_of(const WorldOptions& options);
[[nodiscard]] WorldOptions options_of(const std::string& command);
/// What kind of worlds these are, whatever the seed: "40x30 to 96x72, smallest obstacle, memory, clock".
[[nodiscard]] std::string name_of(const WorldOptions& options);

/// A ball or a capsule whose ends move. Every point of it at one time was somewhere in it at any other, no farther than
/// its ends move meanwhile: at the same part of the axis, with the same offset from it.
struct Solid {
  Place a, b;
  double radius_m = 0;
  bool black = false;  ///< gives no reading
  bool clear = false;  ///< cameras look through it
  double from_s = -std::numeric_limits<double>::infinity();

  [[nodiscard]] Capsule at(double time_s) const { return {a.at(time_s), b.at(time_s), radius_m}; }
  [[nodiscard]] bool exists(double time_s) const { return time_s >= from_s; }
};

/// When a pixel of an exposure is taken. The exposure takes time; nothing may be missed by all of its pixels.
enum class Shutter : std::uint8_t {
  instant,  ///< all pixels at one instant of the exposure
  rolling,  ///< row after row
  longest,  ///< each pixel reads the nearest that it meets in the whole exposure
};

/// What is true of one camera. What is declared stands in rig and settings.
struct TrueCamera {
  Pose T_stated_true = Pose::Identity();  ///< where it stands, seen from where it is taken to stand
  bool moves = false;                     ///< between its exposures; each image says where it was
  /// Each pixel reads the nearest that its ray or one beside it meets; else that of its own ray, and then a filter
  /// radius of at least 1 is declared.
  bool whole_pixels = false;
  Shutter shutter = Shutter::instant;
  SensorMargin noise;  ///< readings err by no more; the same as declared or less
  double too_far = 0;  ///< share of the depth by which readings are too far; an error that nobody declared
  bool extreme_noise = false;
  double lone_holes = 0;   ///< share of pixels
  int round_holes = 0;     ///< most in an image
  double near_specks = 0;  ///< share of pixels that read something nearer
  bool units = false;      ///< 16-bit millimetres
};

/// One image: exposed around mid_s, stamped, and there at arrival_s.
struct Exposure {
  std::size_t camera = 0;
  int number = 0;
  double mid_s = 0;
  double stamp_s = 0;
  double arrival_s = 0;
};

/// Something that the robot lets go: it is there from then on, and the memory is told where.
struct Release {
  Capsule at_world;
  double distance_m = 0;
  double said_s = 0;  ///< before it is there
  double time_s = 0;  ///< images that are stamped with this or later show it for all of their exposure
};

struct World {
  WorldOptions options;
  double duration_s = 0;
  Rig rig;
  views::Settings settings;
  std::vector<TrueCamera> cameras;
  std::vector<Solid> solids;
  std::vector<HalfSpace> walls;
  bool black_walls = false;
  std::vector<Solid> robot;
  double robot_padding_m = 0;
  bool margin_in_test = false;  ///< robot::RemovalSettings
  double robot_speed_m_s = 0;
  std::vector<Exposure> exposures;  ///< in the order in which they arrive
  std::optional<memory::MemorySettings> memory;
  std::optional<Release> release;  ///< with a memory only

  [[nodiscard]] const views::BoxSpace& box() const { return std::get<views::BoxSpace>(settings.space); }
};

/// Everything is drawn from the seed.
[[nodiscard]] World make_world(const WorldOptions& options);

/// Where the camera is taken to stand at an exposure, and where it does.
[[nodiscard]] Pose stated_pose(const World& world, const Exposure& exposure);
[[nodiscard]] Pose true_pose(const World& world, const Exposure& exposure);

/// The robot's links.
[[nodiscard]] std::vector<Capsule> robot_at(const World& world, double time_s);

/// Least distance from the capsule's surface to anything that exists at this time, at least 0. Infinite without
/// anything.
[[nodiscard]] double true_distance_m(const World& world, const Capsule& capsule, double time_s);

/// Half a pixel's diagonal at depth 1.
[[nodiscard]] double half_diagonal(const PinholeCamera& camera);

}  // namespace depthgrid::world
