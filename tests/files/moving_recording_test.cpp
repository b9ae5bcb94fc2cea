// Recordings whose images have time stamps and whose cameras move.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <tuple>

#include "depthgrid/files/png.hpp"
#include "depthgrid/files/recording.hpp"
#include "files/rig_text.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::replaced;
using test::TemporaryFolder;

const std::string kHead = R"({"depth": {"metres_per_unit": 0.0002}, "frames": {@frames}, "cameras": [)";
const std::string kCamera =
    R"({"id": "@id", "width": 8, "height": 6, "fx": 10, "fy": 10, "cx": 3.5, "cy": 2.5, @more})";
const std::string kStands = R"("T_world_cam": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])";

std::string camera(const std::string& id, const std::string& more) {
  return replaced(replaced(kCamera, "@id", id), "@more", more);
}

std::string rig(const std::string& frames, const std::vector<std::string>& cameras) {
  std::string text = replaced(kHead, "@frames", frames);
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    text += (k == 0 ? "" : ", ") + cameras[k];
  }
  return text + "]}";
}

void write_image(const std::filesystem::path& file, std::uint16_t value) {
  std::filesystem::create_directories(file.parent_path());
  write_png_gray16(file, 8, 6, std::vector<std::uint16_t>(48, value));
}

std::uint16_t first_pixel(const Frame& frame) { return *static_cast<const std::uint16_t*>(frame.depth.data); }

TEST(MovingRecording, OfTumByAListAndATrajectory) {
  const TemporaryFolder folder;
  write_image(folder / "depth/1305031102.160407.png", 1);
  write_image(folder / "depth/1305031102.194330.png", 2);
  (void)folder.write("depth.txt",
                     "# timestamp filename\n1305031102.160407 depth/1305031102.160407.png\n"
                     "1305031102.194330 depth/1305031102.194330.png\n");
  (void)folder.write("groundtruth.txt",
                     "# timestamp tx ty tz qx qy qz qw\n1305031102.160407 1 2 3 0 0 0 1\n"
                     "1305031102.190000 1 2 3 0 0 0 1\n1305031102.200000 2 2 3 0 0 0 1\n");
  (void)folder.write("rig.json", rig(R"("pose_gap_s": 0.02)",
                                     {camera("c", R"("depth_list": "depth.txt", "trajectory": "groundtruth.txt")")}));
  Recording recording(folder.path());
  EXPECT_EQ(recording.frame_count(), 2);
  EXPECT_TRUE(recording.has_time_stamps());
  EXPECT_TRUE(recording.moves(0));
  EXPECT_TRUE(recording.has_trajectory());
  EXPECT_EQ(recording.time_s(0), 0.0);
  EXPECT_NEAR(*recording.time_s(1), 0.033923, 1e-6);
  EXPECT_EQ(first_pixel(recording.read(1)[0]), 2);
  EXPECT_NEAR(recording.read(1)[0].time_s, 0.033923, 1e-6);
  EXPECT_TRUE(recording.T_world_camera(0, 0).translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_NEAR(recording.T_world_camera(1, 0).translation().x(), 1.433, 1e-4);
  EXPECT_EQ(recording.files_of(0).size(), 3U) << "image, trajectory, list";
}

TEST(MovingRecording, OfAWristCameraHasTheHandEyePose) {
  const TemporaryFolder folder;
  write_image(folder / "1.5.png", 1);
  (void)folder.write("flange.txt", "1.5 1 0 0 0 0 0.70710678 0.70710678\n");
  (void)folder.write("rig.json", rig("", {camera("c", R"("depth_files": "%f.png", "trajectory": "flange.txt",
                         "T_body_cam": [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])")}));
  EXPECT_TRUE(Recording(folder.path()).T_world_camera(0, 0).translation().isApprox(Eigen::Vector3d(1, 0.1, 0), 1e-6))
      << "0.1 m along the flange's x, which is the world's y";
}

// By a pose a frame, too, and whichever cameras are chosen, in whichever order.
TEST(MovingRecording, EveryCameraMovesWithItsOwnPosesAndHandEyePose) {
  const TemporaryFolder folder;
  const auto hand_eye = [](const std::string& x) {
    return R"("T_body_cam": [[1, 0, 0, )" + x + "], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]";
  };
  for (const std::string id : {"a", "b"}) {
    write_image(folder / (id + "0.png"), 1);
    (void)folder.write(id + "0.txt", "0 -1 0 " + std::string(id == "a" ? "1" : "2") + "\n1 0 0 0\n0 0 1 0\n0 0 0 1\n");
  }
  const auto moving = [&](const std::string& id, const std::string& x) {
    return camera(id, R"("depth_files": ")" + id + R"(%d.png", "pose_files": ")" + id + R"(%d.txt", )" + hand_eye(x));
  };
  (void)folder.write("rig.json", rig(R"("first": 0, "count": 1)", {moving("a", "0.1"), moving("b", "0.2")}));
  const Eigen::Vector3d a(1, 0.1, 0);
  const Eigen::Vector3d b(2, 0.2, 0);
  const auto at = [&](const std::vector<std::string>& ids, std::size_t camera) {
    RecordingOptions options;
    options.camera_ids = ids;
    return Eigen::Vector3d(Recording(folder.path(), options).T_world_camera(0, camera).translation());
  };
  EXPECT_TRUE(at({}, 0).isApprox(a) && at({}, 1).isApprox(b));
  EXPECT_TRUE(at({"b"}, 0).isApprox(b));
  EXPECT_TRUE(at({"b", "a"}, 0).isApprox(b) && at({"b", "a"}, 1).isApprox(a));
}

TEST(MovingRecording, OfSevenScenesAndScanNetByAPoseAFrame) {
  for (const auto& [image, pose, first] :
       {std::tuple("frame-%06d.depth.png", "frame-%06d.pose.txt", 0), std::tuple("depth/%d.png", "pose/%d.txt", 7)}) {
    const TemporaryFolder folder;
    for (int k = first; k < first + 3; ++k) {
      write_image(folder / depth_file_name(image, k), static_cast<std::uint16_t>(k + 1));
      (void)folder.write(depth_file_name(pose, k), "1 0 0 " + std::to_string(k) + "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    }
    (void)folder.write(depth_file_name(pose, first + 2), "-inf -inf -inf -inf\n");
    (void)folder.write(
        "rig.json",
        rig("\"first\": " + std::to_string(first) + ", \"count\": 3, \"rate_hz\": 30",
            {camera("c", std::string("\"depth_files\": \"") + image + "\", \"pose_files\": \"" + pose + "\"")}));
    Recording recording(folder.path());
    EXPECT_FALSE(recording.has_time_stamps());
    EXPECT_EQ(first_pixel(recording.read(1)[0]), first + 2);
    EXPECT_EQ(recording.T_world_camera(1, 0).translation().x(), first + 1);
    EXPECT_EQ(recording.time_s(2), 2 / 30.0);
    EXPECT_EQ(message_of([&] { (void)recording.T_world_camera(2, 0); }, folder.path()),
              depth_file_name(pose, first + 2) +
                  ": line 1: the pose is missing ('-inf': the camera was lost); choose other frames with --frames");
  }
}

TEST(Recording, NamesByTimeStampAndWithTenDigitsNeedNoList) {
  struct Names {
    std::string files, frames;
    std::vector<std::string> images;
    int first;
    bool stamps;
  };
  for (const Names& names : {
           Names{"depth/%f.png", R"("first": 0, "count": 2)", {"1305031102.160407", "1305031102.194330"}, 0, true},
           Names{"depth/%f.png", "", {"1305031102.160407", "1305031102.194330"}, 0, true},
           Names{"depth/", "", {"1305031102.160407", "1305031102.194330"}, 0, true},
           Names{"depth/%010d.png", R"("first": 0, "count": 2)", {"0000000000", "0000000001"}, 0, false},
           Names{"depth/%010d.png", R"("first": 5, "count": 2)", {"0000000005", "0000000006"}, 5, false},
           Names{"depth/", "", {"0000000005", "0000000006"}, 5, false},
           Names{"depth/", R"("first": 5, "count": 2)", {"0000000005", "0000000006"}, 5, false},
       }) {
    const TemporaryFolder folder;
    for (std::size_t k = 0; k < 2; ++k) {
      write_image(folder / ("depth/" + names.images[k] + ".png"), static_cast<std::uint16_t>(k + 1));
    }
    (void)folder.write("rig.json",
                       rig(names.frames, {camera("c", kStands + ", \"depth_files\": \"" + names.files + "\"")}));
    Recording recording(folder.path());
    ASSERT_EQ(recording.frame_count(), 2) << names.files;
    EXPECT_EQ(recording.frame_number(0), names.first);
    EXPECT_EQ(recording.has_time_stamps(), names.stamps);
    EXPECT_EQ(first_pixel(recording.read(0)[0]), 1);
    EXPECT_EQ(first_pixel(recording.read(1)[0]), 2);
    EXPECT_EQ(recording.time_s(1).has_value(), names.stamps);
  }
}

TEST(Recording, NumbersOfAFolderMayHaveGaps) {
  const TemporaryFolder folder;
  for (const int number : {0, 20, 40}) {
    write_image(folder / depth_file_name("left/%06d.png", number), static_cast<std::uint16_t>(number + 1));
    write_image(folder / depth_file_name("right/%d.png", number), static_cast<std::uint16_t>(number + 2));
  }
  std::filesystem::remove(folder / "right/40.png");
  (void)folder.write("rig.json", rig(R"("rate_hz": 10)", {camera("l", kStands + R"(, "depth_files": "left/")"),
                                                          camera("r", kStands + R"(, "depth_files": "right/")")}));
  Recording recording(folder.path());
  ASSERT_EQ(recording.frame_count(), 3);
  EXPECT_EQ(recording.frame_number(1), 20);
  EXPECT_EQ(recording.time_s(1), 2.0);
  EXPECT_EQ(first_pixel(recording.read(1)[1]), 22);
  EXPECT_EQ(message_of([&] { recording.read(2); }, folder.path()), "rig.json: camera 'r' has no image in frame 40");
}

/// Two cameras that are not triggered together: what is near in time is one frame, and only that.
TEST(Recording, FramesArePutTogetherByTime) {
  const TemporaryFolder folder;
  for (const auto& [time, value] : {std::pair("10.000", 1), std::pair("10.100", 2), std::pair("10.200", 3)}) {
    write_image(folder / (std::string("left/") + time + ".png"), static_cast<std::uint16_t>(value));
  }
  for (const auto& [time, value] : {std::pair("10.010", 11), std::pair("10.150", 12), std::pair("10.195", 13)}) {
    write_image(folder / (std::string("right/") + time + ".png"), static_cast<std::uint16_t>(value));
  }
  const std::vector<std::string> cameras{camera("left", kStands + R"(, "depth_files": "left/")"),
                                         camera("right", kStands + R"(, "depth_files": "right/")")};
  (void)folder.write("rig.json", rig(R"("tolerance_s": 0.02, "shared_clock": true)", cameras));
  Recording recording(folder.path());
  ASSERT_EQ(recording.frame_count(), 3);
  EXPECT_EQ(recording.shared_clock(), true);
  EXPECT_FALSE(recording.simultaneous());
  EXPECT_EQ(first_pixel(recording.read(0)[1]), 11);
  EXPECT_NEAR(recording.read(0)[1].time_s, 0.01, 1e-9) << "its own time, not the frame's";
  EXPECT_FALSE(recording.has_image(1, 1)) << "10.150 is 0.05 s away";
  EXPECT_EQ(recording.read(1)[1].depth.data, nullptr);
  EXPECT_EQ(first_pixel(recording.read(1)[0]), 2);
  EXPECT_EQ(first_pixel(recording.read(2)[1]), 13);
  EXPECT_NEAR(recording.read(2)[1].time_s, 0.195, 1e-9);

  (void)folder.write("rig.json", rig(R"("tolerance_s": 0.06)", cameras));
  EXPECT_EQ(first_pixel(Recording(folder.path()).read(1)[1]), 12);
  EXPECT_FALSE(Recording(folder.path()).shared_clock().has_value());
  EXPECT_EQ(Recording(folder.path(), {.camera_ids = {"right"}, .near_m = {}, .far_m = {}}).read(1)[0].time_s,
            10.150 - 10.010);
  (void)folder.write("rig.json", rig("", cameras));
  EXPECT_EQ(
      message_of([&] { Recording(folder / "rig.json"); }, folder.path()),
      "rig.json: /frames/tolerance_s is missing: images of several cameras are put together by their times, and it "
      "says how far apart, in seconds, images of one frame may be");
}

TEST(Recording, ImagesOfOneInstantAreSimultaneous) {
  const TemporaryFolder folder;
  for (const std::string camera : {"left", "right"}) {
    write_image(folder / (camera + "/1.5.png"), 1);
  }
  const std::vector<std::string> cameras{camera("left", kStands + R"(, "depth_files": "left/")"),
                                         camera("right", kStands + R"(, "depth_files": "right/")")};
  (void)folder.write("rig.json", rig(R"("tolerance_s": 0)", cameras));
  EXPECT_TRUE(Recording(folder.path()).simultaneous());
  (void)folder.write("rig.json", rig(R"("tolerance_s": 0, "simultaneous": false)", cameras));
  EXPECT_FALSE(Recording(folder.path()).simultaneous()) << "the stamps do not tell everything";
}

struct Broken {
  std::string frames, camera, message;
};

TEST(MovingRecording, BrokenOnesAreRefusedWithTheirReason) {
  for (const auto& [frames, more, message] : {
           Broken{"", R"("depth_files": "a.png")",
                  "rig.json: /cameras/0: key \"T_world_cam\" is missing; a camera that moves has \"trajectory\" or "
                  "\"pose_files\" in its place"},
           Broken{"", kStands + R"(, "depth_list": "list.txt", "trajectory": "t.txt")",
                  "rig.json: /cameras/0: has T_world_cam, where it stands, and trajectory, where it moves; must have "
                  "one of "
                  "them (a camera on a moving body: T_body_cam)"},
           Broken{"", R"("depth_list": "list.txt", "trajectory": "t.txt", "pose_files": "%d.txt")",
                  "rig.json: /cameras/0: has trajectory and pose_files, must have one of them"},
           Broken{"", kStands + R"(, "depth_list": "list.txt", "depth_files": "%d.png")",
                  "rig.json: /cameras/0: has depth_files and depth_list, must have one of them"},
           Broken{"", R"("depth_files": "%d.png", "trajectory": "t.txt")",
                  "rig.json: /cameras/0: has a trajectory, and its images have numbers, not times; give a depth_list "
                  "(time_s file)"},
           Broken{"", R"("depth_files": "%d.png", "pose_files": "pose.txt")",
                  "rig.json: /cameras/0/pose_files: 'pose.txt' has no %d or %0Nd for the number of the frame"},
           Broken{"", R"("depth_files": "%d.png", "pose_files": "../%d.txt")",
                  "rig.json: /cameras/0/pose_files: '../%d.txt' has a part '..', must stay in the rig file's folder"},
           Broken{
               "", kStands + R"(, "depth_list": "/etc/passwd")",
               "rig.json: /cameras/0/depth_list: '/etc/passwd' is an absolute path, must be relative to the rig file's "
               "folder"},
           Broken{"", kStands + R"(, "depth_list": "none.txt")", "none.txt: cannot be read: No such file or directory"},
           Broken{"", R"("depth_list": "list.txt", "trajectory": "none.txt")",
                  "none.txt: cannot be read: No such file or directory"},
           Broken{R"("count": 3)", kStands + R"(, "depth_list": "list.txt")",
                  "rig.json: /frames/count is 3, but camera 'c' has 2 images; it may be left out"},
           Broken{R"("tolerance_s": -1)", kStands + R"(, "depth_list": "list.txt")",
                  "rig.json: /frames/tolerance_s: value -1 breaks the rule \"minimum\": 0"},
           Broken{"", kStands + R"(, "depth_files": "%f/a.png")",
                  "rig.json: camera 'c': '%f/a.png' has %f in the name of a folder, must have it in the file's name"},
           Broken{
               "", kStands + R"(, "T_body_cam": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])",
               "rig.json: /cameras/0: has T_body_cam, which is for cameras that move, with trajectory or pose_files"},
       }) {
    const TemporaryFolder folder;
    (void)folder.write("list.txt", "1 1.png\n2 2.png\n");
    (void)folder.write("t.txt", "1 0 0 0 0 0 0 1\n");
    (void)folder.write("rig.json", rig(frames, {camera("c", more)}));
    EXPECT_EQ(message_of([&] { Recording(folder / "rig.json"); }, folder.path()), message);
  }
}

TEST(MovingRecording, StampsAndNumbersDoNotMix) {
  const TemporaryFolder folder;
  (void)folder.write("list.txt", "1 1.png\n");
  (void)folder.write("rig.json", rig(R"("tolerance_s": 1)", {camera("a", kStands + R"(, "depth_list": "list.txt")"),
                                                             camera("b", kStands + R"(, "depth_files": "%d.png")")}));
  EXPECT_EQ(message_of([&] { Recording(folder / "rig.json"); }, folder.path()),
            "rig.json: camera 'b' has images without time stamps beside cameras that have some; give it a depth_list");
}

TEST(MovingRig, IsWrittenAsItWasRead) {
  const std::string text = rig(R"("tolerance_s": 0.02, "pose_gap_s": 0.05, "shared_clock": false)",
                               {camera("a", R"("depth_list": "a/list.txt", "trajectory": "a/t.txt",
                 "T_body_cam": [[0, -1, 0, 0.1], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"),
                                camera("b", R"("depth_files": "b/%f.png", "pose_files": "b/%d.txt")"),
                                camera("c", kStands + R"(, "depth_files": "c/")")});
  const RigFile first = parse_rig(text, "first");
  const RigFile second = parse_rig(to_json(first), "second");
  ASSERT_EQ(second.tracks.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(second.tracks[k].depth_list, first.tracks[k].depth_list);
    EXPECT_EQ(second.tracks[k].trajectory, first.tracks[k].trajectory);
    EXPECT_EQ(second.tracks[k].pose_files, first.tracks[k].pose_files);
    EXPECT_TRUE(second.tracks[k].T_body_camera.isApprox(first.tracks[k].T_body_camera));
  }
  EXPECT_EQ(second.depth_files, first.depth_files);
  EXPECT_EQ(second.tolerance_s, 0.02);
  EXPECT_EQ(second.pose_gap_s, 0.05);
  EXPECT_EQ(second.shared_clock, false);
  EXPECT_FALSE(second.count_stated);
}

/// The poses of the recording of a kitchen, once as its rig file states them and once as files of 7-Scenes' form.
TEST(MovingRecording, OfTheRedKitchenHasTheSamePosesAsItsRig) {
  const char* data = std::getenv("DEPTHGRID_DATA");  // NOLINT(concurrency-mt-unsafe)
  const std::filesystem::path kitchen =
      std::filesystem::path(data != nullptr ? data : "../shared/data") / "redkitchen_poses";
  if (!std::filesystem::exists(kitchen / "rig.json")) {
    GTEST_SKIP() << "no recording in " << kitchen << "; DEPTHGRID_DATA says where the recordings are";
  }
  const RigFile known = load_rig(kitchen / "rig.json");
  const TemporaryFolder folder;
  std::filesystem::create_directory_symlink(std::filesystem::absolute(kitchen / "depth"), folder / "depth");
  for (const RigCamera& one : known.rig.cameras) {
    std::ostringstream text;
    text.precision(17);
    text << one.T_world_camera.matrix() << "\n";
    (void)folder.write("pose/" + one.id.substr(1) + ".txt", text.str());
  }
  (void)folder.write("rig.json", R"({"depth": {"metres_per_unit": 0.001, "invalid_values": [0, 65535]}, "cameras": [
      {"id": "hand", "width": 640, "height": 480, "fx": 585, "fy": 585, "cx": 320, "cy": 240,
       "depth_files": "depth/", "pose_files": "pose/%06d.txt"}]})");
  Recording recording(folder.path());
  ASSERT_EQ(recording.frame_count(), static_cast<int>(known.rig.cameras.size()));
  for (int k = 0; k < recording.frame_count(); k += 7) {
    const RigCamera& one = known.rig.cameras[static_cast<std::size_t>(k)];
    EXPECT_EQ("f" + depth_file_name("%06d", recording.frame_number(k)), one.id);
    EXPECT_TRUE(recording.T_world_camera(k, 0).isApprox(one.T_world_camera, 1e-12));
    EXPECT_EQ(recording.read(k)[0].depth.width_px, 640);
  }
}

}  // namespace
}  // namespace depthgrid::files
