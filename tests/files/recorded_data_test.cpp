// Real recordings, where they are present: set DEPTHGRID_DATA to their folder (default ../shared/data).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "depthgrid/files/recording.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

std::filesystem::path data_folder() {
  const char* given = std::getenv("DEPTHGRID_DATA");
  return given != nullptr ? given : "../shared/data";
}

class RecordedData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(data_folder())) {
      GTEST_SKIP() << "no recordings in '" << data_folder().string() << "': set DEPTHGRID_DATA to their folder";
    }
  }
};

struct Depths {
  long valid = 0;
  int least_mm = 65535;
  int greatest_mm = 0;
};

Depths depths_of(const Frame& frame) {
  const auto* pixels = static_cast<const std::uint16_t*>(frame.depth.data);
  Depths depths;
  for (int k = 0; k < frame.depth.width_px * frame.depth.height_px; ++k) {
    if (pixels[k] != 0) {
      ++depths.valid;
      depths.least_mm = std::min<int>(depths.least_mm, pixels[k]);
      depths.greatest_mm = std::max<int>(depths.greatest_mm, pixels[k]);
    }
  }
  return depths;
}

TEST_F(RecordedData, EveryRigFileLoadsAndSurvivesWriting) {
  int rigs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data_folder())) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("rig", 0) == 0 && entry.path().extension() == ".json") {
      const RigFile file = load_rig(entry.path());
      const RigFile again = parse_rig(to_json(file), "written");
      EXPECT_EQ(again.depth_files, file.depth_files) << entry.path();
      EXPECT_TRUE(again.rig.cameras[0].T_world_camera.isApprox(file.rig.cameras[0].T_world_camera, 1e-12));
      ++rigs;
    }
  }
  EXPECT_GE(rigs, 4);
}

TEST_F(RecordedData, ThreeKinectsReadFrameByFrame) {
  Recording recording(data_folder() / "kinect3_ball");
  EXPECT_EQ(recording.frame_count(), 81);
  EXPECT_EQ(recording.rig().cameras.size(), 3U);
  EXPECT_FALSE(recording.rate_hz().has_value());
  ASSERT_TRUE(recording.rig().T_floor_world.has_value());
  const Eigen::Vector3d camera1_floor = *recording.rig().T_floor_world * Eigen::Vector3d::Zero();
  EXPECT_NEAR(camera1_floor.z(), 2.11, 0.005);
  for (const int index : {0, 40, 80}) {
    for (const Frame& frame : recording.read(index)) {
      const double invalid_share = 1.0 - static_cast<double>(depths_of(frame).valid) / (640.0 * 480.0);
      EXPECT_GT(invalid_share, 0.15) << index;
      EXPECT_LT(invalid_share, 0.40) << index;
    }
  }
}

// Counts and ranges as the recording's own description (expected.json) gives them for the same frames.
TEST_F(RecordedData, ImagesOfARealSenseAreTheRecordedOnes) {
  Recording recording(data_folder() / "raw_recordings" / "rig_d435.json");
  const Depths first = depths_of(recording.read(0)[0]);
  EXPECT_EQ(first.valid, 286520);
  EXPECT_EQ(first.least_mm, 341);
  EXPECT_EQ(first.greatest_mm, 3182);
  const Depths second = depths_of(recording.read(1)[0]);
  EXPECT_EQ(second.valid, 286603);
  EXPECT_EQ(second.greatest_mm, 3073);
}

TEST_F(RecordedData, OnlyTwoImagesOfTheKinectAreThere) {
  Recording recording(data_folder() / "raw_recordings" / "rig_kinect.json");
  EXPECT_EQ(depths_of(recording.read(11)[0]).valid, 235130);
  const std::string message = test::message_of([&] { recording.read(5); });
  EXPECT_NE(message.find("kinect_05.png: cannot be read: No such file or directory"), std::string::npos) << message;
}

TEST_F(RecordedData, PosesOfOneMovingKinectActAsCameras) {
  Recording recording(data_folder() / "redkitchen_poses",
                      {.camera_ids = {"f000000", "f000160", "f000480", "f000580"}, .near_m = {}, .far_m = {}});
  EXPECT_EQ(recording.read(0).size(), 4U);
  EXPECT_FALSE(recording.simultaneous());
}

}  // namespace
}  // namespace depthgrid::files
