// Records a running cell as MCAP with messages of ROS 2: images, joint states, answers, and what happened.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/monitor/cell_answer.hpp"
#include "depthgrid/monitor/event.hpp"

namespace depthgrid::monitor {

struct RecorderSettings {
  std::filesystem::path file;
  Names names{};
  Rig rig{};
  Rig standing{};                     ///< its cameras whose places /tf_static tells
  std::vector<std::string> joints{};  ///< names; empty: there is no robot
  std::string frame = "world";        ///< what the world frame is called
  std::string robot_description{};    ///< the URDF's text; empty: not told
  std::filesystem::path cell_file{};  ///< where the cell's file lies
  std::string cell_text{};            ///< and what it says
};

struct RecorderCounts {
  std::uint64_t images = 0;  ///< written, as the next two
  std::uint64_t joint_states = 0;
  std::uint64_t answers = 0;
  std::uint64_t dropped_images = 0;  ///< there was no room, or the disk took no more; as the next two
  std::uint64_t dropped_joint_states = 0;
  std::uint64_t dropped_answers = 0;
  bool failed = false;  ///< nothing more is written
};

/// Topics: /ID/depth/image_raw and camera_info of each camera, /tf_static, /tf of cameras that move, /joint_states,
/// /robot_description, /distances, /events (a text each). Times are since 1970. The cell's file stands in the metadata
/// "depthgrid", with the nanoseconds between the cell's clock and 1970.
/// - Threads: of each of image() (a camera), joints(), answer() one at a time; run() in another. Between them are
///   bounded queues: what does not fit is counted. None of these waits, locks or throws; answer() and joints() do not
///   allocate.
/// - What an answer stands on is in the file before it.
class Recorder {
 public:
  /// Makes the file. Throws Error that names it: it is there already, its folder is not, no permission; a camera whose
  /// name cannot be a topic's.
  explicit Recorder(const RecorderSettings& settings);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// An image of a camera, exposed at time_s, as it came. `T_world_camera`: of one that moves. `joints_s`: the newest
  /// joint state that was known when the robot was taken out of it; NaN: none.
  void image(std::size_t camera, const DepthView& depth, double time_s, const std::optional<Pose>& T_world_camera,
             double joints_s) noexcept;
  void joints(double time_s, std::span<const double> q) noexcept;
  void answer(const CellAnswer& answer) noexcept;
  /// A queue whose events are written, for one thread that pushes. Before run().
  [[nodiscard]] EventQueue& events();

  /// Writes until it is told to stop; then what is left, and the file's summary. A second's work is in the file
  /// whatever happens to the program.
  void run(const std::stop_token& stop) noexcept;

  [[nodiscard]] RecorderCounts counts() const noexcept;
  /// What it has to say itself: that it failed, and why.
  [[nodiscard]] EventQueue& told() noexcept;
  [[nodiscard]] const std::filesystem::path& file() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A pose as a recording holds it, by a unit quaternion: what comes back from one is the same to the bit.
[[nodiscard]] Pose recordable(const Pose& pose) noexcept;

}  // namespace depthgrid::monitor
