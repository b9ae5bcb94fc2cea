// Lists of images, folders of images, trajectories and pose files: what is accepted, and why the rest is not.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "depthgrid/files/image_list.hpp"
#include "depthgrid/files/trajectory.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::TemporaryFolder;

TEST(ImageList, OfTum) {
  const auto images = parse_image_list(
      "\xef\xbb\xbf# depth maps\n# timestamp filename\n1305031102.160407 depth/1305031102.160407.png\r\n\n"
      "1305031102.194330\tdepth/1305031102.194330.png # the second\n",
      "depth.txt");
  ASSERT_EQ(images.size(), 2U);
  EXPECT_DOUBLE_EQ(images[0].time_s, 1305031102.160407);
  EXPECT_EQ(images[0].file, "depth/1305031102.160407.png");
  EXPECT_EQ(images[1].file, "depth/1305031102.194330.png");
}

TEST(ImageList, OfAssociationsInEitherOrder) {
  for (const std::string text : {"1 depth/1.png 1.5 rgb/1.png\n2 depth/2.png 2.5 rgb/2.png\n",
                                 "1.5 rgb/1.png 1 depth/1.png\n2.5 rgb/2.png 2 depth/2.png\n"}) {
    const auto images = parse_image_list(text, "associations.txt");
    ASSERT_EQ(images.size(), 2U);
    EXPECT_EQ(images[1].time_s, 2.0);
    EXPECT_EQ(images[1].file, "depth/2.png");
  }
}

struct Broken {
  std::string text, message;
};

TEST(ImageList, BrokenOnesAreRefusedWithTheirReason) {
  for (const auto& [text, message] : {
           Broken{"", "list.txt: names no image, needs lines of: time_s file"},
           Broken{"# nothing\n", "list.txt: names no image, needs lines of: time_s file"},
           Broken{"1 a.png\nb.png\n",
                  "list.txt: line 2: 1 words, must be 2 (time_s file) or 4 (time_s file time_s file)"},
           Broken{"1 a b.png\n", "list.txt: line 1: 3 words, must be 2 (time_s file) or 4 (time_s file time_s file)"},
           Broken{"1 a.png 1 b.png\n",
                  "list.txt: line 1: one of 'a.png' and 'b.png' must have \"depth\" in its path, to tell which is the "
                  "depth "
                  "image"},
           Broken{"a.png 1\n", "list.txt: line 1: time is 'a.png', must be a number of seconds"},
           Broken{"nan a.png\n", "list.txt: line 1: time is 'nan', must be a number of seconds"},
           Broken{"1305031102160407000 a.png\n",
                  "list.txt: line 1: time is '1305031102160407000', must be at most 1e11 seconds; milliseconds, "
                  "microseconds or nanoseconds have to be divided first"},
           Broken{"2 a.png\n1 b.png\n",
                  "list.txt: line 2: time '1' is not after that of the image before, must ascend"},
           Broken{"2 a.png\n2.0000001 b.png\n",
                  "list.txt: line 2: time '2.0000001' is not after that of the image before, must ascend"},
           Broken{"1 ../a.png\n", "list.txt: line 1: '../a.png' has a part '..', must stay in the rig file's folder"},
           Broken{"1 /a.png\n",
                  "list.txt: line 1: '/a.png' is an absolute path, must be relative to the rig file's folder"},
           Broken{"1 a\x1b.png\n",
                  "list.txt: line 1: 'a\\x1b.png' holds a character that cannot be printed, names of files must not"},
       }) {
    EXPECT_EQ(message_of([&, &list = text] { parse_image_list(list, "list.txt"); }), message);
  }
}

TEST(ImagesOfAFolder, AreInTheOrderOfTheirTimes) {
  const TemporaryFolder folder;
  for (const std::string name : {"1305031102.160407.png", "1305031101.9.png", "._1305031102.160407.png", "notes.txt"}) {
    (void)folder.write(name, "x");
  }
  for (const bool times : {false, true}) {
    const FolderImages images = images_of_folder(folder.path(), "", ".png", times);
    EXPECT_TRUE(images.by_time);
    EXPECT_EQ(images.file, (std::vector<std::string>{"1305031101.9.png", "1305031102.160407.png"}));
    EXPECT_DOUBLE_EQ(images.time_s.at(1), 1305031102.160407);
  }
}

TEST(ImagesOfAFolder, AreInTheOrderOfTheirNumbers) {
  const TemporaryFolder folder;
  for (const std::string name : {"0000000010.png", "0000000009.png", "11.png"}) {
    (void)folder.write(name, "x");
  }
  const FolderImages images = images_of_folder(folder.path(), "", ".png", false);
  EXPECT_FALSE(images.by_time);
  EXPECT_EQ(images.number, (std::vector<int>{9, 10, 11}));
  EXPECT_EQ(images.file, (std::vector<std::string>{"0000000009.png", "0000000010.png", "11.png"}));
  EXPECT_EQ(images_of_folder(folder.path(), "00000000", ".png", true).time_s, (std::vector<double>{9, 10}));
}

TEST(ImagesOfAFolder, OfOtherNamesAreRefused) {
  struct Names {
    std::vector<std::string> files;
    std::string message;
  };
  const std::string way_out = "; write the names as a pattern (\"frame-%06d.png\") or in a list (\"depth_list\")";
  for (const auto& [files, message] : {
           Names{{"notes.txt"}, "d: has no file '....png', so there are no images to read"},
           Names{
               {"1.EXR"},
               "d: has no file '....png' but OpenEXR ('1.EXR'), depth images need to be 16-bit gray PNG: write the "
               "OpenEXR files' depths in units of metres_per_unit (millimetres: 0.001) as such, with OpenCV's imwrite, "
               "say"},
           Names{{"1.jpeg"},
                 "d: has no file '....png' but JPEG ('1.jpeg'), depth images need to be 16-bit gray PNG: JPEG has lost "
                 "the depths, record them anew"},
           Names{{"frame-1.png"}, "d/frame-1.png: the name is no frame's number up to 2147483647" + way_out},
           Names{{"1.png", "01.png"}, "d: '1.png' and '01.png' are of the same number"},
           Names{{"1.5.png", "1.50.png"}, "d: '1.5.png' and '1.50.png' are of the same time"},
           Names{{"99999999999.png"}, "d/99999999999.png: the name is no frame's number up to 2147483647" + way_out},
           Names{{"1403636579763.555584.png"},
                 "d/1403636579763.555584.png: the name is no time in seconds up to 1e11 (1305031102.160407)" + way_out},
       }) {
    const TemporaryFolder folder;
    for (const std::string& file : files) {
      (void)folder.write("d/" + file, "x");
    }
    const std::string said = message_of([&] { images_of_folder(folder / "d", "", ".png", false); }, folder.path());
    if (files.size() == 1) {
      EXPECT_EQ(said, message);
    } else {  // which of the two comes first is the file system's choice
      EXPECT_EQ(said.substr(said.find(" are of")), message.substr(message.find(" are of")));
    }
  }
  const TemporaryFolder folder;
  (void)folder.write("d/1.5.png", "x");
  (void)folder.write("d/2.png", "x");
  EXPECT_NE(message_of([&] { images_of_folder(folder / "d", "", ".png", false); }).find("as those of others here are"),
            std::string::npos);
  EXPECT_EQ(message_of([&] { images_of_folder(folder / "none", "", ".png", false); }, folder.path()),
            "none: cannot be read: No such file or directory");
}

/// Turns by 90 degrees about z within one second and goes 2 m along x; 10 samples a second.
std::vector<StampedPose> turning() {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (int k = 0; k <= 10; ++k) {
    const double half = std::numbers::pi / 4 * k / 10;
    text += std::to_string(100 + 0.1 * k) + " " + std::to_string(0.2 * k) + " 0 1 0 0 " +
            std::to_string(std::sin(half)) + " " + std::to_string(std::cos(half)) + "\n";
  }
  return parse_trajectory(text, "groundtruth.txt");
}

TEST(Trajectory, OfTumIsReadWithQwLast) {
  const auto poses = turning();
  ASSERT_EQ(poses.size(), 11U);
  EXPECT_EQ(poses[10].time_s, 101.0);
  // The body's x axis has turned to the world's y.
  EXPECT_TRUE((poses[10].T_world_body * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, 1, 1), 1e-5));
  EXPECT_TRUE(poses[7].T_world_body.linear().isUnitary(1e-12)) << "six decimals are no unit quaternion, it is made one";
}

TEST(Trajectory, PoseOfThatInstantNeedsNoGap) {
  const auto poses = turning();
  EXPECT_TRUE(pose_at(poses, 100.3, std::nullopt).isApprox(poses[3].T_world_body, 0));
  EXPECT_TRUE(pose_at(poses, 100.3000009, std::nullopt).isApprox(poses[3].T_world_body, 0));
  EXPECT_TRUE(pose_at(poses, 100.2999991, std::nullopt).isApprox(poses[3].T_world_body, 0));
  EXPECT_TRUE(pose_at(poses, 100.0, std::nullopt).isApprox(poses[0].T_world_body, 0));
  EXPECT_TRUE(pose_at(poses, 101.0, std::nullopt).isApprox(poses[10].T_world_body, 0));
}

TEST(Trajectory, IsInterpolatedWithinTheGapAndNotBeyond) {
  const auto poses = turning();
  const Pose half = pose_at(poses, 100.35, 0.11);
  EXPECT_NEAR(half.translation().x(), 0.7, 1e-9);
  const Eigen::AngleAxisd turn(half.linear());
  EXPECT_NEAR(turn.angle(), std::numbers::pi / 2 * 0.35, 1e-5);
  EXPECT_NEAR(turn.axis().z(), 1, 1e-5);
  EXPECT_EQ(
      message_of([&] { pose_at(poses, 100.35, 0.09); }),
      "there is no pose at 100.350000 s, and those around it are 0.1 s apart, more than /frames/pose_gap_s = 0.09; "
      "choose other frames with --frames");
  EXPECT_EQ(
      message_of([&] { pose_at(poses, 100.35, std::nullopt); }),
      "there is no pose at 100.350000 s, the nearest are 0.05 s before and 0.05 s after; state /frames/pose_gap_s to "
      "interpolate between poses that are no farther apart");
}

TEST(Trajectory, EndsWhereItEnds) {
  const auto poses = turning();
  EXPECT_EQ(message_of([&] { pose_at(poses, 99.99, 1e9); }),
            "there is no pose at 99.990000 s: the trajectory begins at 100.000000 s, and nothing is carried beyond it; "
            "choose other frames with --frames");
  EXPECT_EQ(message_of([&] { pose_at(poses, 101.01, 1e9); }),
            "there is no pose at 101.010000 s: the trajectory ends at 101.000000 s, and nothing is carried beyond it; "
            "choose other frames with --frames");
}

TEST(Trajectory, TheShortestArcOfHalfATurnIsNoAnswer) {
  const auto poses = parse_trajectory("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 1 0\n2 0 0 0 0 0 -1 0\n", "t");
  EXPECT_EQ(
      message_of([&] { pose_at(poses, 0.5, 10); }),
      "there is no pose at 0.500000 s, and those of 0.000000 s and 1.000000 s differ by more than 90 degrees, too far "
      "to interpolate");
  EXPECT_TRUE(pose_at(poses, 1.5, 10).isApprox(poses[1].T_world_body, 1e-12)) << "q and -q are one rotation";
}

TEST(Trajectory, BrokenOnesAreRefusedWithTheirReason) {
  for (const auto& [text, message] : {
           Broken{"", "t.txt: holds no pose, needs lines of: time_s tx ty tz qx qy qz qw"},
           Broken{"0 1 2 3 0 0 0\n", "t.txt: line 1: 7 words, must be 8: time_s tx ty tz qx qy qz qw"},
           Broken{"0 1 2 x 0 0 0 1\n", "t.txt: line 1: tz is 'x', must be a finite number"},
           Broken{"0 1 2 inf 0 0 0 1\n", "t.txt: line 1: tz is 'inf', must be a finite number"},
           Broken{"0 1 1e308 3 0 0 0 1\n", "t.txt: line 1: ty is '1e308', must be at most 1e5 m from 0"},
           Broken{"0 1 2 3 0 0 0 0\n",
                  "t.txt: line 1: quaternion (qx qy qz qw) has length 0, must be 1 to within 0.001"},
           Broken{"0 1 2 3 0 0 0 1.01\n",
                  "t.txt: line 1: quaternion (qx qy qz qw) has length 1.01, must be 1 to within 0.001"},
           Broken{"0 1 2 3 0 0 nan 1\n", "t.txt: line 1: qz is 'nan', must be a finite number"},
           Broken{"0 1 2 3 0 0 0 1\n0 1 2 3 0 0 0 1\n",
                  "t.txt: line 2: time '0' is not after that of the pose before, must ascend"},
       }) {
    EXPECT_EQ(message_of([&, &list = text] { parse_trajectory(list, "t.txt"); }), message);
  }
}

TEST(PoseMatrix, OfSevenScenes) {
  const Pose pose =
      parse_pose_matrix(" 0.0\t -1.0\t 0.0\t 1.5\t\n 1 0 0 2.5\r\n 0 0 1 3.5\n 0.0000000e+00 0 0 1.0000000e+00\n", "p");
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1.5, 3.5, 3.5)));
}

TEST(PoseMatrix, BrokenOnesAreRefusedWithTheirReason) {
  for (const auto& [text, message] : {
           Broken{"", "p.txt: 0 numbers, a pose is 16 of them, a 4 x 4 matrix"},
           Broken{"1 0 0 0 0 1 0 0 0 0 1 0", "p.txt: 12 numbers, a pose is 16 of them, a 4 x 4 matrix"},
           Broken{"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1 5\n",
                  "p.txt: line 4: more than 16 numbers, a pose is a 4 x 4 matrix"},
           Broken{"1 0 0 a\n", "p.txt: line 1: 'a' is no number, a pose is 16 of them, a 4 x 4 matrix"},
           Broken{
               "-inf -inf -inf -inf\n",
               "p.txt: line 1: the pose is missing ('-inf': the camera was lost); choose other frames with --frames"},
           Broken{"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n",
                  "p.txt: last row is (0 0 1 1), must be (0 0 0 1); is the matrix transposed?"},
           Broken{"2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n",
                  "p.txt: rotation deviates from orthonormal by 3, must be at most 0.001; it is scaled by 2: divide "
                  "its nine "
                  "numbers by that"},
           Broken{"1 0 0 1e300\n0 1 0 0\n0 0 1 0\n0 0 0 1\n",
                  "p.txt: the translation reaches 1e+300 m, must be at most 100000"},
       }) {
    EXPECT_EQ(message_of([&, &list = text] { parse_pose_matrix(list, "p.txt"); }), message);
  }
}

}  // namespace
}  // namespace depthgrid::files
