// Cameras and joints that are topics of ROS 2.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dds/loopback.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/whole_file.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/ros2_camera.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"
#include "depthgrid/sensors/ros2_joints.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::sensors {
namespace {

using messages::type_of;

/// A driver's node and ours.
class Ros2Source : public testing::Test {
 protected:
  static int domain() { return 50 + static_cast<int>(getpid() % 150); }
  static bool becomes(const std::function<bool()>& holds) {
    const double end_s = clock_now_s() + 20;
    while (!holds()) {
      if (clock_now_s() > end_s) {
        return false;
      }
    }
    return true;
  }
  template <class Message>
  static void send(dds::Publisher& publisher, const Message& message) {
    EXPECT_TRUE(becomes([&] { return publisher.subscribers() > 0; })) << "nobody listens";
    EXPECT_TRUE(publisher.write(messages::to_bytes(message)));
  }

  dds::Node driver_{dds::loopback("driver", domain())};
  std::shared_ptr<dds::Node> node_ = std::make_shared<dds::Node>(dds::loopback("depthgrid", domain()));
};

messages::Image image_of(const std::vector<std::uint16_t>& pixels, int width_px, double time_s) {
  messages::Image image;
  image.header.stamp = stamp_of(time_s);
  image.width = static_cast<std::uint32_t>(width_px);
  image.height = static_cast<std::uint32_t>(pixels.size()) / image.width;
  image.step = 2 * image.width;
  image.encoding = "16UC1";
  image.data = std::as_bytes(std::span(pixels));
  return image;
}

TEST(Ros2Clock, StampsComeBack) {
  const double now_s = clock_now_s();
  EXPECT_NEAR(clock_time_s(stamp_of(now_s)), now_s, 1e-5);
  EXPECT_NEAR(clock_time_s(stamp_of(now_s - 0.25)), now_s - 0.25, 1e-5);
  EXPECT_EQ(stamp_of(std::numeric_limits<double>::quiet_NaN()).sec, 0);
  EXPECT_EQ(stamp_of(-1e18).sec, 0);
  EXPECT_EQ(stamp_of(1e18).nanosec, 0U);
}

TEST_F(Ros2Source, CameraGivesTheNewestImageAndSaysWhatItPassedOver) {
  dds::Publisher images = driver_.publish("/camera/depth/image_raw", type_of<messages::Image>(), dds::kReliable);
  dds::Publisher infos = driver_.publish("/camera/depth/camera_info", type_of<messages::CameraInfo>(), dds::kLatched);
  messages::CameraModel model;
  model.intrinsics = {4, 3, 5, 5, 2, 1.5};
  ASSERT_TRUE(infos.write(messages::to_bytes(messages::camera_info(model, {}))));
  Ros2Camera camera(node_, "/camera/depth/image_raw");
  DepthReading reading;
  EXPECT_EQ(camera.next(reading, 0.01), Reading::failed) << "not open";
  camera.open();
  EXPECT_EQ(camera.info().serial, "/camera/depth/image_raw");
  EXPECT_EQ(camera.next(reading, 0.01), Reading::nothing);
  std::vector<std::uint16_t> pixels(12, 1500);
  const double time_s = clock_now_s() - 0.02;
  for (int n = 0; n < 3; ++n) {
    pixels[5] = static_cast<std::uint16_t>(1000 + n);
    send(images, image_of(pixels, 4, time_s + 1e-3 * n));
  }
  std::int64_t skipped = 0;
  ASSERT_TRUE(becomes([&] {
    const Reading found = camera.next(reading, 0.1);
    EXPECT_NE(found, Reading::failed) << camera.reason();
    skipped += found == Reading::got ? reading.skipped : 0;
    return found == Reading::got && std::abs(reading.time_s - time_s - 2e-3) < 1e-4;
  }));
  EXPECT_LE(skipped, 2);
  ASSERT_EQ(reading.depth.width_px, 4);
  ASSERT_EQ(reading.depth.height_px, 3);
  DepthImage depth(4, 3);
  normalise(reading.depth, MeasurementRule{}, depth);
  EXPECT_FLOAT_EQ(depth.at(1, 1), 1.002F);
  EXPECT_FLOAT_EQ(depth.at(3, 2), 1.5F);
  camera.close();
  EXPECT_EQ(camera.next(reading, 0.01), Reading::failed);
}

TEST_F(Ros2Source, WhatComesTwiceHasOneTime) {
  dds::Publisher images = driver_.publish("/twice/image_raw", type_of<messages::Image>(), dds::kReliable);
  dds::Publisher states = driver_.publish("/twice_states", type_of<messages::JointState>(), dds::kReliable);
  Ros2Camera camera(node_, "/twice/image_raw");
  Ros2Joints joints(node_, "/twice_states", {"a"});
  camera.open();
  joints.open();
  const std::vector<std::uint16_t> pixels(12, 1500);
  const messages::Image image = image_of(pixels, 4, clock_now_s() - 0.02);
  messages::JointState state;
  state.header.stamp = image.header.stamp;
  state.name = {"a"};
  state.position = {0.5};
  std::set<double> times_s;
  for (int n = 0; n < 2000; ++n) {  // the clocks are mostly read alike
    send(images, image);
    send(states, state);
    DepthReading seen;
    JointReading told;
    ASSERT_TRUE(becomes([&] { return camera.next(seen, 0.1) == Reading::got; }));
    ASSERT_TRUE(becomes([&] { return joints.next(told, 0.1) == Reading::got; }));
    times_s.insert(seen.time_s);
    times_s.insert(told.time_s);
  }
  EXPECT_LE(times_s.size(), 2U) << "one of the images, one of the joints: both clocks are read once a stamp";
}

TEST_F(Ros2Source, CameraTakesItsIntrinsicsFromTheTopicBesideIt) {
  dds::Publisher infos = driver_.publish("/left/camera_info", type_of<messages::CameraInfo>(), dds::kReliable);
  messages::CameraModel model;
  model.intrinsics = {64, 48, 60, 61, 32, 24};
  const std::vector<std::byte> message = messages::to_bytes(messages::camera_info(model, {}));
  std::jthread teller([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      (void)infos.write(message);
      usleep(20'000);
    }
  });
  Ros2Camera camera(node_, "/left/image");
  camera.open();
  ASSERT_TRUE(camera.info().intrinsics.has_value());
  EXPECT_EQ(camera.info().intrinsics->width_px, 64);
  EXPECT_NEAR(camera.info().intrinsics->fy_px, 61, 1e-12);
  EXPECT_NEAR(camera.info().intrinsics->cx_px, 32, 1e-12);
}

// The driver begins to speak after the camera was opened: it fails once, and the next open() knows the calibration.
TEST_F(Ros2Source, CalibrationThatComesLateIsNotMissed) {
  Ros2Camera camera(node_, "/late/image");
  camera.open();
  EXPECT_FALSE(camera.info().intrinsics.has_value());
  dds::Publisher infos = driver_.publish("/late/camera_info", type_of<messages::CameraInfo>(), dds::kReliable);
  dds::Publisher images = driver_.publish("/late/image", type_of<messages::Image>(), dds::kReliable);
  messages::CameraModel model;
  model.intrinsics = {4, 3, 5, 5, 2, 1.5};
  send(infos, messages::camera_info(model, {}));
  const std::vector<std::uint16_t> pixels(12, 1500);
  DepthReading reading;
  Reading found = Reading::nothing;
  ASSERT_TRUE(becomes([&] {
    send(images, image_of(pixels, 4, clock_now_s()));
    return (found = camera.next(reading, 0.1)) == Reading::failed;
  }));
  EXPECT_NE(camera.reason().find("says another calibration than when it was opened"), std::string_view::npos)
      << camera.reason();
  camera.close();
  camera.open();
  ASSERT_TRUE(camera.info().intrinsics.has_value());
  EXPECT_EQ(camera.info().intrinsics->width_px, 4);
}

TEST_F(Ros2Source, ImagesOfTwoFramesOnOneTopicAreRefused) {
  dds::Publisher images = driver_.publish("/two/image", type_of<messages::Image>(), dds::kReliable);
  Ros2Camera camera(node_, "/two/image");
  camera.open();
  const std::vector<std::uint16_t> pixels(12, 1500);
  messages::Image image = image_of(pixels, 4, clock_now_s());
  image.header.frame_id = "left";
  send(images, image);
  DepthReading reading;
  Reading found = Reading::nothing;
  ASSERT_TRUE(becomes([&] { return (found = camera.next(reading, 0.1)) != Reading::nothing; }));
  EXPECT_EQ(found, Reading::got) << camera.reason();
  image.header.frame_id = "right";
  send(images, image);
  ASSERT_TRUE(becomes([&] { return (found = camera.next(reading, 0.1)) != Reading::nothing; }));
  EXPECT_EQ(found, Reading::failed);
  EXPECT_NE(camera.reason().find("'left' and 'right'"), std::string_view::npos) << camera.reason();
}

TEST_F(Ros2Source, ALensThatDistortsIsRefused) {
  dds::Publisher infos = driver_.publish("/wide/camera_info", type_of<messages::CameraInfo>(), dds::kLatched);
  messages::CameraModel model;
  model.intrinsics = {64, 48, 60, 61, 32, 24};
  model.distortion = make_distortion(Distortion::Model::rational, std::vector<double>{-0.2, 0.05, 0, 0, 0, 0, 0, 0});
  const std::vector<std::byte> message = messages::to_bytes(messages::camera_info(model, {}));
  std::thread teller([&] {
    for (int n = 0; n < 60; ++n) {
      (void)infos.write(message);
      usleep(20'000);
    }
  });
  Ros2Camera camera(node_, "/wide/image");
  const auto opened = [&] {
    try {
      camera.open();
      return std::string("opened");
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(opened().find("the lens distorts these images"), std::string::npos);
  teller.join();
  EXPECT_NE(opened().find("the lens distorts these images"), std::string::npos) << "also when nobody says it again";
  EXPECT_NE(opened().find("the lens distorts these images"), std::string::npos);
  model.distortion = {};
  EXPECT_TRUE(infos.write(messages::to_bytes(messages::camera_info(model, {}))));
  EXPECT_TRUE(becomes([&] { return opened() == "opened"; })) << "the driver has mended it";
}

TEST_F(Ros2Source, CameraThatSendsColoursHasFailedAndSaysSo) {
  dds::Publisher images = driver_.publish("/camera/image", type_of<messages::Image>(), dds::kReliable);
  Ros2Camera camera(node_, "/camera/image");
  camera.open();
  const std::vector<std::uint16_t> pixels(12, 1500);
  messages::Image image = image_of(pixels, 4, clock_now_s());
  image.encoding = "rgb8";
  send(images, image);
  DepthReading reading;
  Reading found = Reading::nothing;
  ASSERT_TRUE(becomes([&] { return (found = camera.next(reading, 0.1)) != Reading::nothing; }));
  EXPECT_EQ(found, Reading::failed);
  EXPECT_NE(camera.reason().find("/camera/image: "), std::string_view::npos) << camera.reason();
  EXPECT_NE(camera.reason().find("rgb8"), std::string_view::npos) << camera.reason();
}

TEST_F(Ros2Source, CompressedDepthComesAsItWas) {
  dds::Publisher images =
      driver_.publish("/camera/depth/image_raw/compressedDepth", type_of<messages::CompressedImage>(), dds::kReliable);
  Ros2Camera camera(node_, "/camera/depth/image_raw/compressedDepth");
  camera.open();
  const test::TemporaryFolder folder;
  const std::vector<std::uint16_t> pixels{0, 1, 2, 3, 1000, 2000, 3000, 4000, 65535, 7, 8, 9};
  files::write_png_gray16(folder / "a.png", 4, 3, pixels);
  const std::string png = read_whole_file(folder / "a.png", 100000);
  const std::string data = messages::compressed_depth_data(std::as_bytes(std::span(png)));
  messages::CompressedImage image;
  image.header.stamp = stamp_of(clock_now_s());
  image.format = "16UC1; compressedDepth png";
  image.data = std::as_bytes(std::span(data));
  send(images, image);
  DepthReading reading;
  ASSERT_TRUE(becomes([&] { return camera.next(reading, 0.1) == Reading::got; })) << camera.reason();
  ASSERT_EQ(reading.depth.width_px, 4);
  ASSERT_EQ(reading.depth.height_px, 3);
  EXPECT_EQ(reading.depth.metres_per_unit, 0.001);
  const auto* units = static_cast<const std::uint16_t*>(reading.depth.data);
  EXPECT_EQ(std::vector<std::uint16_t>(units, units + 12), pixels);
  image.format = "32FC1; compressedDepth png";
  send(images, image);
  Reading found = Reading::nothing;
  ASSERT_TRUE(becomes([&] { return (found = camera.next(reading, 0.1)) != Reading::nothing; }));
  EXPECT_EQ(found, Reading::failed) << "its depths are rounded";
  EXPECT_NE(camera.reason().find("32FC1"), std::string_view::npos) << camera.reason();
}

/// A frame x metres from its parent.
messages::Transforms frame_at(const char* name, const char* parent, double x, double time_s) {
  messages::TransformStamped stamped;
  stamped.header = {.stamp = stamp_of(time_s), .frame_id = parent};
  stamped.child_frame_id = name;
  stamped.transform.translation.x = x;
  return {.transforms = {stamped}};
}

TEST_F(Ros2Source, ACameraIsWhereItsFrameWasAtTheExposure) {
  dds::Publisher images = driver_.publish("/camera/image", type_of<messages::Image>(), dds::kReliable);
  dds::Publisher standing = driver_.publish("/tf_static", type_of<messages::Transforms>(), dds::kLatched);
  dds::Publisher moving = driver_.publish("/tf", type_of<messages::Transforms>(), dds::kReliable);
  Ros2Camera camera(node_, "/camera/image", {.world = "world", .frame = "camera_optical", .max_age_s = 2});
  Ros2Camera slow(node_, "/camera/image",
                  {.world = "world", .frame = "camera_optical", .max_age_s = 2, .image_frame = {}, .max_speed_m_s = 1});
  EXPECT_THROW(slow.open(), Error);
  const std::vector<std::uint16_t> pixels(12, 1500);
  std::string why;
  try {
    camera.open();
  } catch (const Error& error) {
    why = error.what();
  }
  EXPECT_NE(why.find("lead from frame 'camera_optical' to 'world'"), std::string::npos) << why;
  ASSERT_TRUE(standing.write(messages::to_bytes(frame_at("camera_optical", "flange", 0.25, 0))));
  const double begin_s = clock_now_s() - 0.2;  // far apart beside what the two clocks' readings differ by
  const auto image_at = [&](double time_s, const char* frame) {
    messages::Image image = image_of(pixels, 4, time_s);
    image.header.frame_id = frame;
    return image;
  };
  send(moving, frame_at("flange", "world", 1, begin_s));
  camera.open();
  slow.open();
  DepthReading reading;
  const double exposed_s = clock_now_s();
  send(images, image_at(exposed_s, "/camera_optical"));
  EXPECT_EQ(camera.next(reading, 0.05), Reading::nothing) << "where it is then is not known yet";
  const double later_s = exposed_s + (exposed_s - begin_s);
  while (!wait_until(later_s, 1)) {  // what lies in the future is refused
  }
  send(moving, frame_at("flange", "world", 2, later_s));
  ASSERT_TRUE(becomes([&] {
    const Reading found = camera.next(reading, 0.05);
    EXPECT_NE(found, Reading::failed) << camera.reason();
    return found != Reading::nothing;
  }));
  ASSERT_TRUE(reading.T_world_camera);
  EXPECT_NEAR(reading.T_world_camera->translation().x(), 1.75, 1e-3) << "halfway, and its place on the flange";
  EXPECT_EQ(static_cast<const std::uint16_t*>(reading.depth.data)[11], 1500);
  Reading found = Reading::nothing;
  DepthReading of_slow;
  ASSERT_TRUE(becomes([&] { return (found = slow.next(of_slow, 0.05)) != Reading::nothing; }));
  EXPECT_EQ(found, Reading::failed);
  EXPECT_NE(slow.reason().find("faster than pose: {max_speed_m_s, max_turn_deg_s} says: 1 m/s"), std::string_view::npos)
      << slow.reason();
  send(images, image_at(clock_now_s() + 1, "/camera_optical"));
  ASSERT_TRUE(becomes([&] { return (found = camera.next(reading, 0.05)) != Reading::nothing; }));
  EXPECT_EQ(found, Reading::failed) << "/tf is silent";
  EXPECT_NE(camera.reason().find("the newest transform of frame 'flange' on /tf is"), std::string_view::npos)
      << camera.reason();
}

// A body's frame in place of the optical one turns everything by a quarter.
TEST_F(Ros2Source, ImagesOfAnotherFrameThanThatOnTfAreRefused) {
  dds::Publisher images = driver_.publish("/hand/image", type_of<messages::Image>(), dds::kReliable);
  dds::Publisher standing = driver_.publish("/tf_static", type_of<messages::Transforms>(), dds::kLatched);
  ASSERT_TRUE(standing.write(messages::to_bytes(frame_at("hand_link", "world", 3, 0))));
  const std::vector<std::uint16_t> pixels(12, 1500);
  const auto found_by = [&](Ros2Camera& camera, DepthReading& reading) {
    camera.open();
    Reading found = Reading::nothing;
    EXPECT_TRUE(becomes([&] {
      messages::Image image = image_of(pixels, 4, clock_now_s());
      image.header.frame_id = "hand_optical";
      send(images, image);
      return (found = camera.next(reading, 0.05)) != Reading::nothing;
    }));
    return found;
  };
  DepthReading reading;
  Ros2Camera turned(node_, "/hand/image", {.world = "world", .frame = "hand_link", .max_age_s = 0.1});
  EXPECT_EQ(found_by(turned, reading), Reading::failed);
  EXPECT_NE(turned.reason().find("taken in frame 'hand_optical', and the cell looks for 'hand_link'"),
            std::string_view::npos)
      << turned.reason();
  Ros2Camera renamed(node_, "/hand/image",
                     {.world = "world", .frame = "hand_link", .max_age_s = 0.1, .image_frame = "/hand_optical"});
  EXPECT_EQ(found_by(renamed, reading), Reading::got) << renamed.reason();
  EXPECT_NEAR(reading.T_world_camera->translation().x(), 3, 1e-9);
}

TEST_F(Ros2Source, JointsAreFoundByTheirNames) {
  dds::Publisher states = driver_.publish("/joint_states", type_of<messages::JointState>(), dds::kReliable);
  Ros2Joints joints(node_, "/joint_states", {"shoulder", "elbow"});
  joints.open();
  messages::JointState gripper;
  gripper.name = {"finger"};
  gripper.position = {0.02};
  messages::JointState arm;
  arm.name = {"finger", "elbow", "shoulder"};
  arm.position = {0.01, -2, 1};
  const double time_s = clock_now_s() - 0.01;
  arm.header.stamp = stamp_of(time_s);
  send(states, gripper);
  send(states, arm);
  JointReading reading;
  ASSERT_TRUE(becomes([&] {
    const Reading found = joints.next(reading, 0.1);
    EXPECT_NE(found, Reading::failed) << joints.reason();
    return found == Reading::got;
  }));
  ASSERT_EQ(reading.q.size(), 2U);
  EXPECT_EQ(reading.q[0], 1);
  EXPECT_EQ(reading.q[1], -2);
  EXPECT_NEAR(reading.time_s, time_s, 1e-4);
}

TEST_F(Ros2Source, JointsOfAnotherRobotHaveFailedAndSaySo) {
  dds::Publisher states = driver_.publish("/joint_states", type_of<messages::JointState>(), dds::kReliable);
  Ros2Joints joints(node_, "/joint_states", {"shoulder", "elbow"});
  joints.open();
  messages::JointState other;
  other.name = {"shoulder"};
  other.position = {0.5};
  JointReading reading;
  Reading found = Reading::nothing;
  ASSERT_TRUE(becomes([&] {
    send(states, other);
    return (found = joints.next(reading, 0.1)) != Reading::nothing;
  }));
  EXPECT_EQ(found, Reading::failed);
  EXPECT_NE(joints.reason().find("no joint 'elbow'"), std::string_view::npos) << joints.reason();
  joints.close();
  joints.open();
  other.position.clear();
  ASSERT_TRUE(becomes([&] {
    send(states, other);
    return (found = joints.next(reading, 0.1)) != Reading::nothing;
  }));
  EXPECT_EQ(found, Reading::failed);
  EXPECT_NE(joints.reason().find("no position for each name"), std::string_view::npos) << joints.reason();
}

}  // namespace
}  // namespace depthgrid::sensors
