// A robot cell as its file describes it: cameras, robot, what counts as an obstacle, what is asked, where answers go.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/memory/settings.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::cell {

/// Where a camera's images, or the joints' positions, come from.
enum class SourceKind : std::uint8_t { recording, simulated, realsense, freenect, openni, ros2 };

/// "recording", "simulated", "realsense", ...: as in the file.
[[nodiscard]] std::string_view to_string(SourceKind kind) noexcept;

/// A value of the file with its unit and where it comes from: "line 12", "default", "device", "model realsense_d435".
struct ShownValue {
  std::string key;  ///< as a path: "cameras[0].pose.position_m"
  std::string value;
  std::string unit;  ///< empty: none
  std::string origin;
};

/// What is said of a camera's errors in place of its sensor model's numbers. Metres, radians, seconds.
struct MarginEntry {
  std::optional<double> constant_m{};
  std::optional<double> linear{};
  std::optional<double> quadratic_per_m{};
  std::optional<int> lateral_px{};
  std::optional<double> translation_m{};
  std::optional<double> rotation_rad{};
  std::optional<double> half_exposure_s{};
  std::optional<double> time_uncertainty_s{};
  std::optional<double> second_view_x_m{};
};

struct CameraEntry {
  std::string name;
  std::filesystem::path recording{};          ///< its folder, or an MCAP file, or a file of the camera's maker
  std::string recorded_as{};                  ///< the camera's id in it
  std::string device{};                       ///< serial number (empty: the only one), or topic (of a recording:
                                              ///< empty: found by recorded_as)
  std::string info_topic{};                   ///< of an MCAP file's camera_info; empty: beside the images
  double rate_hz = 30;                        ///< of a simulated camera, or of a RealSense
  std::optional<double> metres_per_unit{};    ///< of its images' numbers; none: of the rig file, or 0.001
  std::optional<double> arrival_lag_s{};      ///< from the exposure to the arrival, at most: of stamps of the arrival
  std::filesystem::path rig_file{};           ///< says intrinsics and pose of the camera of this name
  std::optional<PinholeCamera> intrinsics{};  ///< none: from the rig file, or from the device
  std::optional<Pose> T_world_camera{};       ///< none: from the rig file, or of `frame`
  std::string frame{};                        ///< of /tf and /tf_static: where a topic's images are taken
  double frame_age_s = 0.1;                   ///< how old a transform of it may be
  std::string image_frame{};                  ///< what the images call it; empty: `frame`
  std::optional<double> frame_speed_m_s{};    ///< the fastest that its origin moves
  std::optional<double> frame_turn_rad_s{};   ///< the fastest that it turns
  std::string sensor{};                       ///< a sensor model; empty: the rig file's, or none
  MarginEntry margins{};                      ///< in place of the model's
  double smallest_obstacle_m = 0;             ///< declared
  std::string place{};                        ///< "FILE:LINE:COLUMN: cameras[0]", for messages
  SourceKind source = SourceKind::recording;
  bool repeat = false;        ///< a recording begins again at its end
  bool is_silent = false;     ///< its recording holds no image of it
  bool mirrored = false;      ///< a recording of OpenNI2 whose images are
  bool equal_images = false;  ///< the same pixels twice in a row are no failure
};

struct JointsEntry {
  SourceKind source = SourceKind::simulated;
  std::filesystem::path file{};  ///< of recorded positions
  std::string topic{};
  bool repeat = false;
  double rate_hz = 500;     ///< of simulated joints
  double time_error_s = 0;  ///< between the joints' clock and the images'
};

struct RobotEntry {
  std::string urdf{};  ///< a file, or the name of a robot that is built in: kuka_lwr4
  bool is_built_in = false;
  Pose T_world_base = Pose::Identity();
  JointsEntry joints{};
  double padding_m = 0;
  bool margin_in_test = false;
  std::optional<double> joint_acceleration{};  ///< the greatest of all joints, rad/s^2
  std::string tool{};                          ///< link of the tool's tip: asked first; empty: none
  std::string place{};
};

/// A point or a ball that stands still, world frame, metres.
struct PointEntry {
  std::string name;
  Eigen::Vector3d at_world_m = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

struct AskEntry {
  double rate_hz = 500;
  double rho_m = kDefaultRho;
  double resolution_m = 0.005;
  double stop_m = 0;                   ///< a part that is not farther than this, beyond its blind layer, says stop
  double hold_s = 0;                   ///< a stop lasts until all was clear for so long
  std::optional<double> stopping_s{};  ///< what the robot takes to stand still, for the log
  bool moving_links = false;           ///< every link that at least two joints move
  std::vector<std::string> links{};    ///< or these
  std::vector<PointEntry> points{};
};

struct AgeEntry {
  double image_s = 0.5;
  double joints_s = 0.1;
};

struct UdpEntry {
  std::string host{};  ///< an address of IPv4
  int port = 0;
};

/// The node that cameras, joints and answers of ROS 2 go through.
struct Ros2Entry {
  std::string node = "depthgrid";
  std::string name_space = "/";
  int domain = 0;               ///< as the ROS_DOMAIN_ID of the other nodes
  std::string frame = "world";  ///< what the world frame is called there
};

struct OutputEntry {
  std::optional<UdpEntry> udp{};
  std::filesystem::path jsonl{};   ///< empty: none
  std::filesystem::path record{};  ///< an MCAP file that is made; empty: none. "{time}" in its name is the time of day
  std::filesystem::path log{};     ///< a line for each stop and go is added to it; empty: none
  std::filesystem::path prometheus{};  ///< is replaced once a second; empty: none
  bool terminal = true;
  bool ros2 = false;  ///< topics of the node
};

/// - Units: metres, radians, seconds; world frame. Angles of the file are degrees.
/// - Paths are absolute, or relative to the working folder as the file's own path is.
struct Cell {
  std::filesystem::path file{};
  std::string text{};  ///< what the file says
  std::string name{};
  std::vector<CameraEntry> cameras{};
  std::optional<RobotEntry> robot{};
  views::BoxSpace space{};
  views::Policies policies{};
  double v_max_m_s = 0;
  std::optional<memory::MemorySettings> memory{};  ///< none: declared that nothing is remembered
  AskEntry ask{};
  AgeEntry ages{};
  Ros2Entry ros2{};
  OutputEntry outputs{};
  std::vector<ShownValue> shown{};  ///< every value, in the file's order
};

}  // namespace depthgrid::cell
