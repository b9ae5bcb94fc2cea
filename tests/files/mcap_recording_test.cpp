// MCAP files as recordings: a folder's frames come back to the bit, cameras are found and placed by their messages, and
// what is missing or broken is said in a line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/mcap_export.hpp"
#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/files/recording.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "files/rig_text.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::read_bytes;
using test::replaced;
using test::small_rig;
using test::TemporaryFolder;
using ::testing::HasSubstr;

/// The small rig with random images, the right one with lens distortion.
void write_folder(const TemporaryFolder& folder, int frames = 3) {
  const std::string lens = replaced(replaced(small_rig(), "[0, 0, 0, 0, 0]", "[-0.3, 0, 0, 0, 0]"),
                                    "2.25,\n     \"dist", "2.5,\n     \"dist");
  static_cast<void>(folder.write("rig.json", replaced(lens, "\"count\": 10", "\"count\": " + std::to_string(frames))));
  std::filesystem::create_directories(folder / "left");
  std::filesystem::create_directories(folder / "right");
  std::mt19937 random(5);
  for (int frame = 3; frame < 3 + frames; ++frame) {
    for (const char* pattern : {"left/depth_%03d.png", "right/%03d.png"}) {
      std::vector<std::uint16_t> pixels(48);
      for (std::uint16_t& pixel : pixels) {
        const std::uint16_t kSpecial[] = {0, 65535, 2047, 9000};
        pixel = random() % 8 == 0 ? kSpecial[random() % 4] : static_cast<std::uint16_t>(400 + random() % 5000);
      }
      write_png_gray16(folder / depth_file_name(pattern, frame), 8, 6, pixels);
    }
  }
}

McapChoice with_rig(const std::filesystem::path& rig) {
  McapChoice choice;
  choice.rig = rig;
  choice.tolerance_s = 1e-4;
  return choice;
}

RecordingOptions chosen(McapChoice choice, std::vector<std::string> ids = {}) {
  RecordingOptions options;
  options.camera_ids = std::move(ids);
  options.mcap = std::move(choice);
  return options;
}

/// Every measured depth of every frame, its time and the poses: the same bits.
void expect_same(Recording& a, Recording& b) {
  ASSERT_EQ(a.frame_count(), b.frame_count());
  ASSERT_EQ(a.rig().cameras.size(), b.rig().cameras.size());
  EXPECT_EQ(to_string(a.rig()), to_string(b.rig()));
  for (int index = 0; index < a.frame_count(); ++index) {
    EXPECT_EQ(a.frame_number(index), b.frame_number(index));
    const auto of_a = a.read(index);
    const auto of_b = b.read(index);
    for (std::size_t k = 0; k < of_a.size(); ++k) {
      const RigCamera& camera = a.rig().cameras[k];
      EXPECT_EQ(of_a[k].time_s, of_b[k].time_s);
      ASSERT_EQ(of_a[k].depth.width_px, of_b[k].depth.width_px);
      for (int v = 0; v < of_a[k].depth.height_px; ++v) {
        for (int u = 0; u < of_a[k].depth.width_px; ++u) {
          ASSERT_EQ(measured_depth_m(of_a[k].depth, camera.rule, u, v),
                    measured_depth_m(of_b[k].depth, camera.rule, u, v))
              << camera.id << ' ' << u << ' ' << v;
        }
      }
      EXPECT_EQ(a.T_world_camera(index, k).matrix(), b.T_world_camera(index, k).matrix());
    }
  }
}

/// A sphere and a capsule before the cameras, frame by frame.
std::vector<Answer> answers_of(Recording& recording) {
  Rig rig = recording.rig();
  for (RigCamera& camera : rig.cameras) {
    camera.margins = CameraMargins{};
    camera.margins->smallest_obstacle_m = 0;
  }
  const views::Settings settings{.space = views::BoxSpace{{-2, -2, 0}, {2, 2, 4}},
                                 .policies = {.unobserved = views::Policy::obstacle,
                                              .outside = views::Policy::ignored,
                                              .robot_pockets = views::Policy::obstacle},
                                 .margins = camera_margins(rig),
                                 .v_max_m_s = 1.0};
  search::SearchEvaluator evaluator(rig, settings, {.max_image_age_s = 3600});
  std::vector<Answer> all;
  for (int index = 0; index < recording.frame_count(); ++index) {
    double now_s = 0;
    const auto frames = recording.read(index);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      static_cast<void>(evaluator.update(k, frames[k]));
      now_s = std::max(now_s, frames[k].time_s);
    }
    for (const Capsule& capsule :
         {Capsule{{0.5, 0, 0.3}, {0.5, 0, 0.3}, 0.02}, Capsule{{0.4, 0, 0.2}, {0.6, 0.1, 0.5}, 0.01}}) {
      all.push_back(evaluator.distance(capsule, now_s));
    }
  }
  return all;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void expect_same_answers(const std::vector<Answer>& a, const std::vector<Answer>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(same_bits(a[i].nearest.distance_m, b[i].nearest.distance_m)) << i;
    EXPECT_TRUE(same_bits(a[i].distance_now_m, b[i].distance_now_m)) << i;
    EXPECT_EQ(a[i].nearest.state, b[i].nearest.state);
    EXPECT_EQ(a[i].nearest.camera, b[i].nearest.camera);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(same_bits(a[i].nearest.nearest_world[axis], b[i].nearest.nearest_world[axis])) << i;
      EXPECT_TRUE(same_bits(a[i].nearest.direction_world[axis], b[i].nearest.direction_world[axis])) << i;
    }
  }
}

TEST(McapRecording, AFolderComesBackToTheBit) {
  for (const McapCompression compression : {McapCompression::none, McapCompression::lz4, McapCompression::zstd}) {
    const TemporaryFolder folder;
    write_folder(folder);
    Recording before(folder.path());
    save_mcap(before, folder / "a.mcap", {.compression = compression, .chunk_bytes = 400});
    Recording after(folder / "a.mcap", chosen(with_rig(folder / "rig.json")));
    EXPECT_EQ(after.rig_file(), folder / "rig.json");
    EXPECT_EQ(after.mcap_file(), folder / "a.mcap");
    EXPECT_TRUE(after.simultaneous());
    EXPECT_TRUE(after.has_time_stamps());
    expect_same(before, after);
    expect_same_answers(answers_of(before), answers_of(after));
  }
}

/// A rotation goes through a quaternion, which rounds.
TEST(McapRecording, CamerasAreFoundAndPlacedByTheirMessages) {
  const TemporaryFolder folder;
  write_folder(folder);
  Recording before(folder.path());
  save_mcap(before, folder / "a.mcap");
  McapChoice choice;
  choice.tolerance_s = 1e-4;
  Recording after(folder / "a.mcap", chosen(choice));
  ASSERT_EQ(after.rig().cameras.size(), 2U);
  EXPECT_EQ(after.rig().name, "a");
  EXPECT_EQ(after.rig_file(), folder / "a.mcap");
  for (std::size_t k = 0; k < 2; ++k) {
    const RigCamera& camera = after.rig().cameras[k];
    EXPECT_EQ(camera.id, k == 0 ? "left" : "right");
    EXPECT_EQ(camera.intrinsics.cx_px, before.rig().cameras[k].intrinsics.cx_px);
    EXPECT_EQ(camera.intrinsics.width_px, before.rig().cameras[k].intrinsics.width_px);
    EXPECT_LE((camera.T_world_camera.matrix() - before.rig().cameras[k].T_world_camera.matrix()).cwiseAbs().maxCoeff(),
              1e-15);
    EXPECT_EQ(after.recorded_distortion(k).coefficients, before.recorded_distortion(k).coefficients);
  }
  EXPECT_THAT(after.notes(), ::testing::Contains(HasSubstr("the world is frame 'world'")));
  EXPECT_THAT(after.notes(), ::testing::Contains(HasSubstr("camera 'left': 3 images of /left/depth/image_raw")));
  // Without the rig file's near, far and clamping the depths are what was measured.
  const DepthView left = after.read_recorded(1, 0);
  EXPECT_EQ(left.format, DepthFormat::uint16_units);
  EXPECT_EQ(after.read_recorded(1, 1).format, DepthFormat::float32_metres) << "half millimetres";
  Recording one(folder / "a.mcap", chosen({}, {"right"}));
  EXPECT_EQ(one.rig().cameras.size(), 1U);
}

TEST(McapRecording, RealRecordingsComeBackToTheBit) {
  const char* given = std::getenv("DEPTHGRID_DATA");
  const std::filesystem::path data =
      std::filesystem::path(given != nullptr ? given : "../shared/data") / "kinect3_ball";
  if (!std::filesystem::exists(data / "rig.json")) {
    GTEST_SKIP() << "no " << data << ": set DEPTHGRID_DATA to the folder that holds it";
  }
  const TemporaryFolder folder;
  RigFile part = load_rig(data / "rig.json");
  part.frame_count = 3;
  part.count_stated = true;
  save_rig(part, folder / "rig.json");
  for (const auto& entry : std::filesystem::directory_iterator(data)) {
    if (entry.is_directory()) {
      std::filesystem::create_directory_symlink(std::filesystem::absolute(entry.path()),
                                                folder / entry.path().filename().string());
    }
  }
  Recording before(folder.path());
  save_mcap(before, folder / "a.mcap");
  Recording after(folder / "a.mcap", chosen(with_rig(folder / "rig.json")));
  expect_same(before, after);
  expect_same_answers(answers_of(before), answers_of(after));
}

// A frame's images are in chunks of their own, and the memory of one chunk is used again for the next: each has to stay
// as it is until the next frame is read. Names of both lengths, so that pixels lie at even places of some messages.
TEST(McapRecording, AnImageStaysWhileTheOtherCamerasIsRead) {
  for (const std::string& more : {std::string(), std::string("x"), std::string("xx"), std::string("xxx")}) {
    const TemporaryFolder folder;
    RigFile file;
    file.frame_count = 1;
    file.count_stated = true;
    file.rate_hz = 10;
    for (char name = 'a'; name < 'm'; ++name) {
      RigCamera camera;
      camera.id = name + more;
      camera.intrinsics = {64, 48, 60, 60, 32, 24};
      file.rig.cameras.push_back(camera);
      file.depth_files.push_back(camera.id + "_%03d.png");
    }
    save_rig(file, folder / "rig.json");
    for (std::size_t k = 0; k < 12; ++k) {
      write_png_gray16(folder / depth_file_name(file.depth_files[k], 0), 64, 48,
                       std::vector<std::uint16_t>(std::size_t{64} * 48, static_cast<std::uint16_t>(1000 + 250 * k)));
    }
    Recording before(folder.path());
    for (const std::size_t chunk_bytes : {1, 400, 900, 7000}) {
      save_mcap(before, folder / "a.mcap", {.compression = McapCompression::none, .chunk_bytes = chunk_bytes});
      Recording after(folder / "a.mcap", chosen(with_rig(folder / "rig.json")));
      const auto frames = after.read(0);
      for (std::size_t k = 0; k < 12; ++k) {
        const auto expected = static_cast<float>(1 + 0.25 * static_cast<double>(k));
        for (const auto& [u, v] : {std::pair(0, 0), std::pair(31, 20), std::pair(63, 47)}) {
          EXPECT_EQ(measured_depth_m(frames[k].depth, after.rig().cameras[k].rule, u, v), expected)
              << k << more << ", chunks of " << chunk_bytes;
        }
      }
    }
  }
}

TEST(McapRecording, IsReadFromTheFolderOfABag) {
  const TemporaryFolder folder;
  write_folder(folder);
  Recording before(folder.path());
  std::filesystem::create_directory(folder / "bag");
  save_mcap(before, folder / "bag" / "bag_0.mcap");
  static_cast<void>(folder.write("bag/metadata.yaml", "rosbag2_bagfile_information:"));
  Recording after(folder / "bag", chosen(with_rig(folder / "rig.json")));
  EXPECT_EQ(after.mcap_file(), folder / "bag" / "bag_0.mcap");
  expect_same(before, after);
  std::filesystem::copy_file(folder / "bag" / "bag_0.mcap", folder / "bag" / "bag_1.mcap");
  EXPECT_THAT(message_of([&] { Recording(folder / "bag"); }), HasSubstr("bag: holds several MCAP files; name one"));
}

TEST(McapRecording, ACutFileIsReadUpToThere) {
  const TemporaryFolder folder;
  write_folder(folder, 10);
  Recording before(folder.path());
  save_mcap(before, folder / "a.mcap", {.compression = McapCompression::zstd, .chunk_bytes = 600});
  const std::string bytes = read_bytes(folder / "a.mcap");
  const auto cut = folder.write("cut.mcap", std::string_view(bytes).substr(0, bytes.size() / 2));
  Recording after(cut, chosen(with_rig(folder / "rig.json")));
  EXPECT_GT(after.frame_count(), 0);
  EXPECT_LT(after.frame_count(), 10);
  EXPECT_THAT(after.notes().back(), HasSubstr("within the record at byte"));
  EXPECT_EQ(before.read(0)[0].time_s, after.read(0)[0].time_s);
}

// Files of messages by hand.

messages::Image wall(std::span<const std::uint16_t> pixels, int nanosec, const char* frame_id = "cam") {
  messages::Image image;
  image.header = {.stamp = {.sec = 100, .nanosec = static_cast<std::uint32_t>(nanosec)}, .frame_id = frame_id};
  image.width = 8;
  image.height = 6;
  image.encoding = "16UC1";
  image.step = 16;
  image.data = std::as_bytes(pixels);
  return image;
}

messages::CameraInfo info_of_wall() {
  return messages::camera_info({.intrinsics = {8, 6, 10, 10, 4, 3}, .distortion = {}}, {});
}

messages::TransformStamped transform(const char* parent, const char* child) {
  messages::TransformStamped stamped;
  stamped.header.frame_id = parent;
  stamped.child_frame_id = child;
  stamped.transform.translation.x = 1;
  return stamped;
}

/// What a test changes before the file is written.
struct Contents {
  std::vector<std::uint16_t> pixels = std::vector<std::uint16_t>(48, 2000);
  std::string image_topic = "/cam/depth/image_raw";
  std::vector<messages::Image> images{wall(pixels, 0), wall(pixels, 1000)};
  std::vector<messages::CompressedImage> compressed;
  std::string info_topic = "/cam/depth/camera_info";
  std::vector<messages::CameraInfo> infos{info_of_wall()};
  std::vector<messages::Transforms> tf_static{{{transform("map", "base"), transform("base", "cam")}}};
  std::vector<messages::Transforms> tf;
  McapChoice choice{};
  std::string bytes{};  ///< of another image, for compressed

  void write(const std::filesystem::path& file) const {
    McapWriter writer(file);
    const auto put = [&](const std::string& topic, const auto& all) {
      if (all.empty()) {
        return;
      }
      const auto channel = writer.add_channel(topic, messages::type_of<std::decay_t<decltype(all[0])>>());
      std::uint64_t time_ns = 1;
      for (const auto& message : all) {
        writer.write(channel, time_ns++, 1, to_bytes(message));
      }
    };
    put(image_topic, images);
    put(image_topic + "/compressedDepth", compressed);
    put(info_topic, infos);
    put("/tf_static", tf_static);
    put("/tf", tf);
    put("/words", std::vector<messages::Text>{{"text"}});
    writer.close();
  }
};

struct BrokenRecording {
  const char* name;
  std::function<void(Contents&)> change;
  const char* message;  ///< a part of it
  bool choice = false;  ///< what was asked for, not the file
};

void PrintTo(const BrokenRecording& broken, std::ostream* out) { *out << broken.name; }

class BrokenMcapRecording : public ::testing::TestWithParam<BrokenRecording> {};

INSTANTIATE_TEST_SUITE_P(
    Mcap, BrokenMcapRecording,
    ::testing::Values(
        BrokenRecording{
            "NoDepthTopic", [](Contents& c) { c.images.clear(); },
            "a.mcap: has no depth images: no sensor_msgs/msg/Image of 16UC1 or 32FC1, and no "
            "CompressedImage of compressedDepth; topics: /cam/depth/camera_info (sensor_msgs/msg/CameraInfo), "
            "/tf_static (tf2_msgs/msg/TFMessage), /words (std_msgs/msg/String)"},
        BrokenRecording{"OnlyColour", [](Contents& c) { c.images[0].encoding = c.images[1].encoding = "rgb8"; },
                        "has no depth images"},
        BrokenRecording{"ColourChosen",
                        [](Contents& c) {
                          c.images[0].encoding = "bgr8";
                          c.choice.depth_topics = {"/cam/depth/image_raw"};
                        },
                        "topic '/cam/depth/image_raw': the image's encoding is 'bgr8', a depth image needs 16UC1"},
        BrokenRecording{"JpegChosen",
                        [](Contents& c) {
                          c.compressed.push_back({.header = {}, .format = "bgr8; jpeg compressed bgr8", .data = {}});
                          c.choice.depth_topics = {"/cam/depth/image_raw/compressedDepth"};
                        },
                        "the image's format is 'bgr8; jpeg compressed bgr8', depth needs '16UC1; compressedDepth'"},
        BrokenRecording{"InverseDepth",
                        [](Contents& c) {
                          c.compressed.push_back({.header = {}, .format = "32FC1; compressedDepth png", .data = {}});
                          c.choice.depth_topics = {"/cam/depth/image_raw/compressedDepth"};
                        },
                        "its inverse depths are rounded"},
        BrokenRecording{"UnknownTopic", [](Contents& c) { c.choice.depth_topics = {"/left"}; },
                        "there is no topic '/left'; topics: /cam/depth/image_raw (sensor_msgs/msg/Image), ", true},
        BrokenRecording{"TopicOfWords", [](Contents& c) { c.choice.depth_topics = {"/words"}; },
                        "topic '/words' holds std_msgs/msg/String, no images"},
        BrokenRecording{"TwoTopicsOfACamera",
                        [](Contents& c) {
                          c.choice.depth_topics = {"a=/cam/depth/image_raw", "a=/cam/depth/image_raw"};
                        },
                        "two topics are of camera 'a'", true},
        BrokenRecording{
            "NoCameraInfo", [](Contents& c) { c.info_topic = "/other/camera_info"; },
            "topic '/cam/depth/image_raw' has no calibration: there is no /cam/depth/camera_info (camera_info "
            "topics: /other/camera_info); give a rig file"},
        BrokenRecording{"CalibrationChanges",
                        [](Contents& c) {
                          c.infos.push_back(c.infos[0]);
                          c.infos[1].k[0] = 11;
                        },
                        "topic '/cam/depth/camera_info': the calibration changes at 2 ns"},
        BrokenRecording{"NotCalibrated", [](Contents& c) { c.infos[0].k.fill(0); }, "K is all 0"},
        BrokenRecording{"CalibrationOfAnotherSize", [](Contents& c) { c.infos[0].width = 9; },
                        "image of 100000000000 ns: is 8 x 6 pixels, the calibration of camera 'cam' is for 9 x 6"},
        BrokenRecording{
            "NoTransforms", [](Contents& c) { c.tf_static.clear(); },
            "no transform says where its frame 'cam' stands (frames of /tf_static: none); give a rig file, or "
            "--world cam if it is the only camera"},
        BrokenRecording{"NoFrameId",
                        [](Contents& c) { c.images[0].header.frame_id = c.images[1].header.frame_id = ""; },
                        "its images have no frame_id"},
        BrokenRecording{"FrameIdChanges", [](Contents& c) { c.images[1].header.frame_id = "other"; },
                        "frame_id is 'other', before it was 'cam'"},
        BrokenRecording{"CameraMoves",
                        [](Contents& c) {
                          c.tf_static = {{{transform("wrist", "cam")}}};
                          c.tf = {{{transform("base", "wrist")}}};
                        },
                        "frame 'cam' moves: 'wrist' stands in 'base' by /tf, which changes"},
        BrokenRecording{"CameraOnAnArmThatStoodOnce",
                        [](Contents& c) {
                          c.tf_static = {{{transform("map", "base"), transform("base", "cam")}}};
                          c.tf = {{{transform("map", "base")}}};
                        },
                        "frame 'cam' moves: 'base' stands in 'map' by /tf, which changes"},
        BrokenRecording{"GapBetweenFrames",
                        [](Contents& c) {
                          c.tf_static = {{{transform("map", "base"), transform("wrist", "cam")}}};
                          c.choice.world_frame = "map";
                        },
                        "no transform leads from frame 'cam' to 'map': the first ends at 'wrist', the second at 'map'"},
        BrokenRecording{"UnknownWorld", [](Contents& c) { c.choice.world_frame = "odom"; },
                        "there is no frame 'odom'; frames of /tf_static: 'base', 'cam', 'map'", true},
        BrokenRecording{"RingOfFrames",
                        [](Contents& c) {
                          c.tf_static = {{{transform("cam", "base"), transform("base", "cam")}}};
                        },
                        "the frames above 'cam' go around in a ring"},
        BrokenRecording{"TwoParents",
                        [](Contents& c) {
                          c.tf_static = {{{transform("map", "cam")}}, {{transform("base", "cam")}}};
                        },
                        "frame 'cam' stands in 'map' and in 'base'"},
        BrokenRecording{"TwoPlaces",
                        [](Contents& c) {
                          c.tf_static.push_back({{transform("base", "cam")}});
                          c.tf_static[1].transforms[0].transform.translation.x = 2;
                        },
                        "frame 'cam' stands in two places of 'base' on /tf_static"},
        BrokenRecording{"NoRotation", [](Contents& c) { c.tf_static[0].transforms[1].transform.rotation.w = 0; },
                        "transform from 'cam' to 'base': its quaternion has the length 0, must be 1"},
        BrokenRecording{"EndlessTranslation",
                        [](Contents& c) { c.tf_static[0].transforms[1].transform.translation.y = HUGE_VAL; },
                        "its translation is 1, inf, 0 m, must be within 100000"},
        BrokenRecording{"SameStampTwice", [](Contents& c) { c.images[1].header.stamp = c.images[0].header.stamp; },
                        "two images have the time stamp 100000000000 ns in their header"},
        BrokenRecording{"ShortImage", [](Contents& c) { c.images[0].data = c.images[0].data.first(90); },
                        "the image has 90 bytes, 8 x 6 pixels of 16UC1 with a step of 16 need 96"},
        BrokenRecording{
            "RigOfOtherCameras", [](Contents& c) { c.choice.rig = "rig.json"; },
            "rig.json: camera 'left' has no images in a.mcap: name its topic, left=TOPIC, or leave the camera "
            "out; topics: ",
            true}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_P(BrokenMcapRecording, IsRefusedInOneLine) {
  const TemporaryFolder folder;
  Contents contents;
  GetParam().change(contents);
  if (!contents.choice.rig.empty()) {
    contents.choice.rig = folder.write("rig.json", small_rig());
  }
  contents.write(folder / "a.mcap");
  bool is_choice = false;
  const std::string why = message_of(
      [&] {
        try {
          Recording recording(folder / "a.mcap", chosen(contents.choice));
          static_cast<void>(recording.read(0));
        } catch (const ChoiceError&) {
          is_choice = true;
          throw;
        }
      },
      folder.path());
  EXPECT_THAT(why, HasSubstr(GetParam().message));
  EXPECT_THAT(why, HasSubstr("a.mcap"));
  EXPECT_TRUE(is_printable(why)) << why;
  EXPECT_EQ(is_choice, GetParam().choice);
}

TEST(McapRecording, WhatIsWholeIsRead) {
  const TemporaryFolder folder;
  Contents contents;
  contents.write(folder / "a.mcap");
  Recording recording(folder / "a.mcap");
  EXPECT_EQ(recording.frame_count(), 2);
  EXPECT_EQ(recording.rig().cameras[0].id, "cam");
  EXPECT_EQ(recording.rig().cameras[0].T_world_camera.translation().x(), 2) << "map to base to cam";
  EXPECT_EQ(recording.read(1)[0].time_s, 100.000001 - 100.0);
  contents.choice.world_frame = "base";
  Recording in_base(folder / "a.mcap", chosen(contents.choice));
  EXPECT_EQ(in_base.rig().cameras[0].T_world_camera.translation().x(), 1);
}

TEST(McapRecording, OneCameraAloneMayBeTheWorld) {
  const TemporaryFolder folder;
  Contents contents;
  contents.tf_static.clear();
  contents.choice.world_frame = "cam";
  contents.write(folder / "a.mcap");
  const Recording recording(folder / "a.mcap", chosen(contents.choice));
  EXPECT_EQ(recording.rig().cameras[0].T_world_camera.matrix(), Pose::Identity().matrix());
}

TEST(McapRecording, ImagesAreInTheOrderOfTheirStamps) {
  const TemporaryFolder folder;
  Contents contents;
  std::swap(contents.images[0], contents.images[1]);
  contents.write(folder / "a.mcap");
  Recording recording(folder / "a.mcap");
  EXPECT_EQ(recording.start_s(), 100);
  EXPECT_GT(recording.read(1)[0].time_s, 0);
}

/// Of both forms of one image the one is taken to which nothing was done; alone the compressed one is read.
TEST(McapRecording, CompressedDepthIsRead) {
  const TemporaryFolder folder;
  Contents contents;
  std::vector<std::uint16_t> pixels(48, 1234);
  write_png_gray16(folder / "a.png", 8, 6, pixels);
  const std::string png = read_bytes(folder / "a.png");
  const std::string data = messages::compressed_depth_data(std::as_bytes(std::span(png)));
  contents.compressed.push_back({.header = {.stamp = {.sec = 5, .nanosec = 0}, .frame_id = "cam"},
                                 .format = "16UC1; compressedDepth png",
                                 .data = std::as_bytes(std::span(data))});
  contents.write(folder / "a.mcap");
  Recording both(folder / "a.mcap");
  EXPECT_EQ(measured_depth_m(both.read(0)[0].depth, {}, 0, 0), 2.0F);
  contents.images.clear();
  contents.write(folder / "b.mcap");
  Recording alone(folder / "b.mcap");
  EXPECT_EQ(alone.rig().cameras[0].id, "cam");
  EXPECT_EQ(measured_depth_m(alone.read(0)[0].depth, {}, 7, 5), 1.234F);
  contents.infos[0].height = 7;
  contents.write(folder / "c.mcap");
  EXPECT_THAT(message_of([&] { static_cast<void>(Recording(folder / "c.mcap").read(0)); }),
              HasSubstr("is 8 x 6 pixels, the calibration of camera 'cam' is for 8 x 7"));
}

TEST(McapRecording, OfRectifiedImagesPCounts) {
  const TemporaryFolder folder;
  Contents contents;
  contents.image_topic = "/cam/depth/image_rect";
  contents.infos[0].d = {-0.3, 0, 0, 0, 0};
  contents.infos[0].p[0] = 12;
  contents.write(folder / "a.mcap");
  Recording recording(folder / "a.mcap");
  EXPECT_EQ(recording.rig().cameras[0].intrinsics.fx_px, 12);
  EXPECT_EQ(recording.distorted(0), nullptr);
}

TEST(McapRecording, TopicsMayBeNamed) {
  const TemporaryFolder folder;
  Contents contents;
  contents.images[0].encoding = contents.images[1].encoding = "mono16";
  contents.choice.depth_topics = {"front=/cam/depth/image_raw"};
  contents.write(folder / "a.mcap");
  const Recording recording(folder / "a.mcap", chosen(contents.choice));
  EXPECT_EQ(recording.rig().cameras[0].id, "front");
  EXPECT_THAT(message_of([&] { Recording(folder / "a.mcap"); }), HasSubstr("has no depth images")) << "infrared";
}

TEST(McapRecording, SeveralCamerasNeedATolerance) {
  const TemporaryFolder folder;
  write_folder(folder);
  Recording before(folder.path());
  save_mcap(before, folder / "a.mcap");
  EXPECT_THAT(message_of([&] { Recording(folder / "a.mcap"); }),
              HasSubstr("has 2 cameras, and nothing says how far apart, in seconds, images of one frame may be"));
  McapChoice choice;
  choice.world_frame = "map";
  EXPECT_THAT(message_of([&] { Recording(folder.path(), chosen(choice)); }),
              HasSubstr("are chosen of MCAP files only"));
}

TEST(SaveMcap, RefusesWhatMessagesCannotSay) {
  const TemporaryFolder folder;
  write_folder(folder);
  static_cast<void>(folder.write("rig.json", replaced(read_bytes(folder / "rig.json"), "\"left\"", "\"the left\"")));
  Recording recording(folder.path());
  EXPECT_EQ(message_of([&] { save_mcap(recording, folder / "a.mcap"); }),
            "camera 'the left': its id cannot be the name of a topic, which has letters, digits, _ and / only");
}

}  // namespace
}  // namespace depthgrid::files
