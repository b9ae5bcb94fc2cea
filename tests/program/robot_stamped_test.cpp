// depthgrid distances --urdf on recordings with time stamps, and cameras that move.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "program/robot_cell.hpp"

namespace depthgrid::test {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using namespace robot_cell;

/// As write_cell(), with a time stamp an image, 20 ms later those of the right camera; at 1 s of the joints' clock the
/// arm begins to pan evenly, and the left camera stands elsewhere in the second frame.
const std::vector<double> kLeftTimes_s{1700000001.0, 1700000001.1};
constexpr double kRightLater_s = 0.02;

Position stamped_position(double time_s) { return {0.2 - 2 * (time_s - kLeftTimes_s[0]), -0.3}; }

void write_stamped_cell(const TemporaryFolder& folder) {
  files::RigFile file = rig_file();
  file.frame_count = 1;
  file.first_frame = 0;
  file.rate_hz.reset();
  file.simultaneous = false;
  file.tolerance_s = 0.03;
  file.shared_clock = true;
  file.tracks.resize(2);
  file.tracks[0].trajectory = "left.txt";
  std::string trajectory;
  for (std::size_t k = 0; k < 2; ++k) {
    file.depth_files[k] = file.rig.cameras[k].id + "/%f.png";
    std::filesystem::create_directories(folder / file.rig.cameras[k].id);
    for (std::size_t i = 0; i < 2; ++i) {
      const double time_s = kLeftTimes_s[i] + (k == 0 ? 0 : kRightLater_s);
      const bool elsewhere = k == 0 && i == 1;
      const Pose T_world_camera =
          elsewhere ? look_at({-0.9, -1.2, 1.0}, {0.5, 0.4, 0.6}) : rig_file().rig.cameras[k].T_world_camera;
      const DepthImage depth = scene(links_at(stamped_position(time_s)), true)
                                   .render(file.rig.cameras[k].intrinsics, T_world_camera)
                                   .depth_m;
      std::vector<std::uint16_t> pixels(depth.index(0, depth.height_px()));
      std::transform(depth.data(), depth.data() + pixels.size(), pixels.begin(),
                     [](float z) { return static_cast<std::uint16_t>(std::lround(1000 * z)); });
      const std::string stamp = std::to_string(time_s);  // six decimals
      files::write_png_gray16(folder / (file.rig.cameras[k].id + "/" + stamp + ".png"), 320, 240, pixels);
      if (k == 0) {
        const Eigen::Quaterniond q(T_world_camera.linear());
        const Vector3d t = T_world_camera.translation();
        std::ostringstream line;
        line.precision(17);
        line << stamp << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z()
             << ' ' << q.w() << '\n';
        trajectory += line.str();
      }
    }
  }
  file.rig.cameras[0].T_world_camera = Pose::Identity();
  files::save_rig(file, folder / "rig.json");
  (void)folder.write("left.txt", trajectory);
  (void)folder.write("arm.urdf", kUrdf);
  std::ostringstream joints;
  joints.precision(17);
  joints << "time_s,pan,tilt\n";
  for (int i = -2; i <= 14; ++i) {
    const double time_s = kLeftTimes_s[0] + 0.01 * i;
    joints << time_s << ',' << stamped_position(time_s).pan << ',' << stamped_position(time_s).tilt << '\n';
  }
  (void)folder.write("joints.csv", joints.str());
}

const std::string kStampedQuestion = kQuestion + "--static-scene --joint-time-error 0 " + kRobot;

/// All but single pixels along an edge that the model, grown for rounding, covers by 0.01 mm.
std::string all_taken(const std::string& camera, const std::string& images) {
  return "camera '" + camera + "', " + images +
         ": [0-9 ]+ pixels taken for the robot, [0-9 ]+ of them beside its capsules; [0-9 ]+ show its capsules: taken "
         "(99.[89]|100.0) %, not because the reading is farther 0.[0-2] %, nearer 0.0 %, missing 0.0 %\n";
}

/// The arm pans by 40 mrad between the images of a frame: the right image shows it 4 cm beside the left one's.
TEST(RobotInRecording, IsTakenWhereItWasAtEachTimeStampAndTheCameraToo) {
  const TemporaryFolder folder;
  write_stamped_cell(folder);
  const auto result = run_command(kStampedQuestion + "--robot-padding 0.006", folder);
  const auto distances = column(result, "distance_m");
  EXPECT_THAT(result.err, ContainsRegex(all_taken("left", "2 images")));
  EXPECT_THAT(result.err, ContainsRegex(all_taken("right", "2 images")));
  ASSERT_EQ(distances.size(), 4U) << result.err;
  for (const int frame : {0, 1}) {
    // Where they are at the newer image, the right one: that is the time of the answers.
    const auto links = links_at(stamped_position(kLeftTimes_s[static_cast<std::size_t>(frame)] + kRightLater_s));
    Vector3d on_axis;
    for (const auto& [name, axis] : {std::pair("on_axis_x_m", 0), {"on_axis_y_m", 1}, {"on_axis_z_m", 2}}) {
      on_axis[axis] = std::stod(column(result, name).at(std::to_string(frame) + " fore"));
    }
    EXPECT_LT(distance_to_axis(links[1], on_axis), 0.001);
    const double fore_m = distance_m({links[1]}, kObstacle.a) - kObstacle.radius_m;
    const double hand_m = distance_m({links[2], links[3]}, kObstacle.a) - kObstacle.radius_m;
    for (const auto& [name, truth_m] : {std::pair("fore", fore_m), std::pair("hand", hand_m)}) {
      EXPECT_LE(std::stod(distances.at(std::to_string(frame) + " " + name)), std::min(truth_m, 0.6) + 1e-6) << name;
    }
  }
  // 20 ms beside the images' clock the links are missed.
  const auto beside = run_command(kStampedQuestion + "--robot-padding 0.006 --joint-time-offset -0.02", folder);
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_THAT(beside.err, Not(ContainsRegex(all_taken("left", "2 images"))));
  EXPECT_THAT(beside.err, Not(ContainsRegex(all_taken("right", "2 images"))));
  const auto least = run_command(kStampedQuestion + "--least-padding", folder);
  EXPECT_EQ(least.exit_code, 2);
  EXPECT_THAT(least.err, HasSubstr("--least-padding takes cameras that stand still and numbered images"));
}

TEST(RobotInRecording, ACameraWithoutImageInAFrameShowsNoRobot) {
  const TemporaryFolder folder;
  write_stamped_cell(folder);
  std::filesystem::remove(folder / "right/1700000001.020000.png");
  const auto result = run_command(kStampedQuestion + "--robot-padding 0.006 --frames 0:1 --pictures pictures", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, ContainsRegex(all_taken("left", "2 images")));
  EXPECT_THAT(result.err, ContainsRegex(all_taken("right", "1 image")));
}

TEST(RobotInRecording, TimeStampsAskForJointsOverTimeOnTheirClock) {
  const TemporaryFolder folder;
  write_stamped_cell(folder);
  (void)folder.write("joints.csv", "frame,pan,tilt\n0,0.2,-0.3\n1,0,-0.3\n");
  const auto by_frame = run_command(kStampedQuestion, folder);
  EXPECT_EQ(by_frame.exit_code, 1);
  EXPECT_THAT(by_frame.err, AllOf(HasSubstr("joints.csv: "), HasSubstr("time stamps"), HasSubstr("column 'time'")));
  (void)folder.write("joints.csv", "time_s,pan,tilt\n0,0.2,-0.3\n0.06,0.1,-0.3\n0.12,0,-0.3\n");
  const auto since_the_start = run_command(kStampedQuestion, folder);
  EXPECT_EQ(since_the_start.exit_code, 1);
  EXPECT_THAT(since_the_start.err, AllOf(HasSubstr("camera 'left', at 1700000001"), HasSubstr("--joint-time-offset")));
  EXPECT_EQ(run_command(kStampedQuestion + "--joint-time-offset 1700000001", folder).exit_code, 0);
}

}  // namespace
}  // namespace depthgrid::test
