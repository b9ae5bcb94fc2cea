// Recordings made here: frames arrive with the right pixels, scale and time; wrong ones are refused.
#include "depthgrid/files/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "files/rig_text.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::small_rig;
using test::small_rig_with;
using test::TemporaryFolder;

constexpr int kWidth = 8;
constexpr int kHeight = 6;

/// All pixels `value`, in units of the camera.
void write_image(const std::filesystem::path& file, std::uint16_t value, int width = kWidth) {
  std::filesystem::create_directories(file.parent_path());
  write_png_gray16(file, width, kHeight, std::vector<std::uint16_t>(static_cast<std::size_t>(width * kHeight), value));
}

/// The small rig with images of frames 3 and 4: 1000 + frame on the left, 2000 + frame on the right.
void write_recording(const TemporaryFolder& folder, const std::string& rig = small_rig()) {
  static_cast<void>(folder.write("rig.json", rig));
  for (const int frame : {3, 4}) {
    write_image(folder / depth_file_name("left/depth_%03d.png", frame), static_cast<std::uint16_t>(1000 + frame));
    write_image(folder / depth_file_name("right/%03d.png", frame), static_cast<std::uint16_t>(2000 + frame));
  }
}

float depth_m(const Recording& recording, const Frame& frame, std::size_t camera, int u, int v) {
  return measured_depth_m(frame.depth, recording.rig().cameras[camera].rule, u, v).value_or(0.0F);
}

TEST(Recording, ReadsEveryCameraOfAFrame) {
  const TemporaryFolder folder;
  write_recording(folder);
  Recording recording(folder.path());
  EXPECT_EQ(recording.frame_count(), 10);
  EXPECT_EQ(recording.frame_number(1), 4);
  EXPECT_TRUE(recording.simultaneous());
  EXPECT_EQ(recording.rate_hz(), 4.0);
  const std::span<const Frame> frames = recording.read(1);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_FLOAT_EQ(depth_m(recording, frames[0], 0, 7, 5), 1.004F);
  EXPECT_FLOAT_EQ(depth_m(recording, frames[1], 1, 0, 0), 1.002F);  // half a millimetre a unit
  EXPECT_EQ(frames[0].time_s, 0.25);
  EXPECT_EQ(frames[0].robot.near_m, nullptr);
}

TEST(Recording, HandsOutTheImageWithoutACopy) {
  const TemporaryFolder folder;
  write_recording(folder);
  Recording recording(folder.path());
  const Frame* frames = recording.read(0).data();
  const void* pixels = frames[0].depth.data;
  EXPECT_EQ(frames[0].depth.format, DepthFormat::uint16_units);
  EXPECT_EQ(frames[1].depth.format, DepthFormat::uint16_units)
      << "a model whose coefficients are all 0 distorts nothing";
  EXPECT_EQ(frames[0].depth.stride_bytes, kWidth * 2);
  EXPECT_EQ(recording.read(1).data(), frames);
  EXPECT_EQ(frames[0].depth.data, pixels);
}

TEST(Recording, TakesTheCamerasAskedForInTheirOrder) {
  const TemporaryFolder folder;
  write_recording(folder);
  Recording both(folder / "rig.json", {.camera_ids = {"right", "left"}, .near_m = {}, .far_m = {}});
  EXPECT_EQ(both.rig().cameras[0].id, "right");
  EXPECT_FLOAT_EQ(depth_m(both, both.read(0)[0], 0, 0, 0), 1.0015F);
  Recording one(folder / "rig.json", {.camera_ids = {"left"}, .near_m = {}, .far_m = {}});
  EXPECT_EQ(one.read(0).size(), 1U);
}

TEST(Recording, NearAndFarMayBeSetByTheCaller) {
  const TemporaryFolder folder;
  write_recording(folder);
  Recording recording(folder.path(), {.camera_ids = {}, .near_m = 1.002, .far_m = 1.5});
  EXPECT_EQ(recording.rig().cameras[0].rule.near_m, 1.002);
  EXPECT_EQ(recording.rig().cameras[1].rule.far_m, 1.5);
  const std::span<const Frame> frames = recording.read(0);
  EXPECT_FLOAT_EQ(depth_m(recording, frames[0], 0, 1, 1), 1.003F);
  EXPECT_EQ(depth_m(recording, frames[1], 1, 1, 1), 0.0F);  // 1.0015 m is nearer than near_m
}

/// Beyond far_m is decided before the lens distortion is removed: afterwards it cannot be told from "no measurement".
TEST(Recording, TheCallersTreatmentBeyondFarHoldsWithLensDistortion) {
  for (const std::string lens : {"[0, 0, 0, 0, 0]", "[-0.3, 0, 0, 0, 0]"}) {
    const TemporaryFolder folder;
    write_recording(folder, small_rig_with("[0, 0, 0, 0, 0]", lens));
    write_image(folder / "right/003.png", 9000);  // 4.5 m, the camera reaches to 4 m and its rule is to clamp
    for (const auto& [given, expected_m] :
         {std::pair(std::optional<bool>(), 4.0F), std::pair(std::optional(true), 4.0F),
          std::pair(std::optional(false), 0.0F)}) {
      Recording recording(folder.path(),
                          {.camera_ids = {"right"}, .near_m = {}, .far_m = {}, .clamp_beyond_far = given});
      EXPECT_EQ(depth_m(recording, recording.read(0)[0], 0, 4, 3), expected_m) << lens;
    }
  }
}

TEST(Recording, IndexStandsInForTimeWhereTheRateIsUnknown) {
  const TemporaryFolder folder;
  write_recording(folder, small_rig_with(", \"rate_hz\": 4", ""));
  Recording recording(folder.path());
  EXPECT_FALSE(recording.rate_hz().has_value());
  EXPECT_EQ(recording.read(1)[0].time_s, 1.0);
}

/// A centred lens of 8 x 6 pixels that pulls the corners inward, and one near pixel: after the removal no pixel is
/// farther than the plane, the near pixel is still there and the model is gone.
TEST(Recording, RemovesDistortionWithoutBlending) {
  const TemporaryFolder folder;
  write_recording(folder, test::replaced(small_rig_with("[0, 0, 0, 0, 0]", "[-0.3, 0, 0, 0, 0]"), "2.25,\n     \"dist",
                                         "2.5,\n     \"dist"));
  std::vector<std::uint16_t> pixels(kWidth * kHeight, 2000);
  pixels[3 * kWidth + 4] = 1000;
  write_png_gray16(folder / "right/003.png", kWidth, kHeight, pixels);
  Recording recording(folder.path());
  EXPECT_EQ(recording.rig().cameras[1].distortion.model, Distortion::Model::none);
  const Frame frame = recording.read(0)[1];
  ASSERT_EQ(frame.depth.format, DepthFormat::float32_metres);
  int near = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const float depth = depth_m(recording, frame, 1, u, v);
      EXPECT_TRUE(depth == 0.0F || depth == 0.5F || depth == 1.0F) << u << ", " << v << ": " << depth;
      near += depth == 0.5F ? 1 : 0;
    }
  }
  EXPECT_GE(near, 1);
  EXPECT_EQ(depth_m(recording, frame, 1, 4, 3), 0.5F);
}

/// The coefficients of an Azure Kinect in wide mode, rounded: a ray 55 degrees off the axis is in the recorded image,
/// so it has to be in the one that is handed out.
TEST(Recording, KeepsTheViewOfAWideLens) {
  const TemporaryFolder folder;
  static_cast<void>(
      folder.write("rig.json", R"({"cameras": [{"id": "wide", "width": 128, "height": 128, "fx": 63, "fy": 63,
    "cx": 63.7, "cy": 64, "metres_per_unit": 0.001, "depth_files": "d.png",
    "distortion": {"model": "rational_polynomial", "coeffs": [0.9, 0.12, 0.0004, -0.0003, 0.004, 1.23, 0.33, 0.018]},
    "T_world_cam": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})"));
  write_png_gray16(folder / "d.png", 128, 128, std::vector<std::uint16_t>(std::size_t{128} * 128, 2000));
  Recording recording(folder.path());
  const PinholeCamera& camera = recording.rig().cameras[0].intrinsics;
  EXPECT_EQ(camera.fx_px, 63.0);
  const Frame frame = recording.read(0)[0];
  ASSERT_EQ(frame.depth.width_px, camera.width_px);
  for (const double x : {-1.43, 1.43}) {  // tan(55 degrees)
    const int u = static_cast<int>(x * camera.fx_px + camera.cx_px);
    ASSERT_TRUE(camera.contains(u, static_cast<int>(camera.cy_px)));
    EXPECT_EQ(depth_m(recording, frame, 0, u, static_cast<int>(camera.cy_px)), 2.0F);
  }
  ASSERT_NE(recording.distorted(0), nullptr);
  EXPECT_EQ(recording.distorted(0)->width_px(), 128);
  const std::vector<bool> read = recording.pixels_read(0);
  EXPECT_LT(std::count(read.begin(), read.end(), false), 128 * 128 / 10);
}

struct Broken {
  const char* name;
  std::function<void(const TemporaryFolder&)> action;  ///< gets a folder with the small recording in it
  const char* message;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

class BrokenRecording : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenRecording, IsRefusedWithItsReason) {
  const TemporaryFolder folder;
  write_recording(folder);
  EXPECT_EQ(message_of([&] { GetParam().action(folder); }, folder.path()), GetParam().message);
}

RecordingOptions cameras(std::vector<std::string> ids) {
  return {.camera_ids = std::move(ids), .near_m = {}, .far_m = {}};
}

const Broken kBroken[] = {
    {"AbsentFolder", [](const TemporaryFolder& f) { Recording(f / "other"); },
     "other: cannot be read: No such file or directory"},
    {"FolderWithoutRig",
     [](const TemporaryFolder& f) {
       std::filesystem::remove(f / "rig.json");
       Recording(f / ".");
     },
     "./rig.json: cannot be read: No such file or directory"},
    {"TextAsRig", [](const TemporaryFolder& f) { Recording(f.write("notes.txt", "day one\n")); },
     "notes.txt: line 1, column 1: JSON syntax: Invalid value. Near: day one"},
    {"ImageNotRecorded", [](const TemporaryFolder& f) { Recording(f / "rig.json").read(2); },
     "left/depth_005.png: cannot be read: No such file or directory"},
    {"ImageOfOtherSize",
     [](const TemporaryFolder& f) {
       write_image(f / "right/004.png", 1, 9);
       Recording(f / "rig.json").read(1);
     },
     "right/004.png: is 9 x 6 pixels, the calibration of camera 'right' is for 8 x 6"},
    {"ImageTruncated",
     [](const TemporaryFolder& f) {
       const std::string png = test::read_bytes(f / "right/003.png");
       Recording(f.write("rig.json", small_rig())).read(0);
       static_cast<void>(f.write("right/003.png", png.substr(0, png.size() - 15)));
       Recording(f / "rig.json").read(0);
     },
     "right/003.png: broken PNG: the file ends too early (truncated)"},
    {"IndexBehindTheEnd", [](const TemporaryFolder& f) { Recording(f / "rig.json").read(10); },
     "rig.json: there is no frame index 10, must be from 0 to 9"},
    {"NegativeIndex", [](const TemporaryFolder& f) { Recording(f / "rig.json").read(-1); },
     "rig.json: there is no frame index -1, must be from 0 to 9"},
    {"UnknownCamera",
     [](const TemporaryFolder& f) {
       Recording(f / "rig.json", cameras({"left", "centre"}));
     },
     "rig.json: rig 'small': there is no camera 'centre', its cameras are left, right"},
    {"CameraTwice",
     [](const TemporaryFolder& f) {
       Recording(f / "rig.json", cameras({"left", "left"}));
     },
     "rig.json: camera 'left' is chosen twice"},
    {"CameraWithoutImages",
     [](const TemporaryFolder& f) {
       Recording(f.write("rig.json", small_rig_with("\"depth_files\": \"right/%03d.png\", ", "")));
     },
     "rig.json: camera 'right' has no depth_files and no depth_list, so there are no images to read"},
    {"NearBeyondFar",
     [](const TemporaryFolder& f) { Recording(f / "rig.json", {.camera_ids = {}, .near_m = 5.0, .far_m = {}}); },
     "rig.json: camera 'right': far is 4 m, must be greater than near (5 m)"},
};
INSTANTIATE_TEST_SUITE_P(All, BrokenRecording, ::testing::ValuesIn(kBroken),
                         [](const auto& broken) { return broken.param.name; });

}  // namespace
}  // namespace depthgrid::files
