// What a running cell says to ROS 2.
#include "depthgrid/monitor/ros2_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dds/loopback.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/ros2_messages.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"

namespace depthgrid::monitor {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

Names names() { return {.cell = "cell", .cameras = {"left", "right"}, .parts = {"hand", "fore", "upper"}}; }

/// The hand before a surface, the fore arm beside unseen space, nothing near the upper arm.
CellAnswer answer() {
  CellAnswer result;
  result.time_s = sensors::clock_now_s();
  result.stop = true;
  result.distance_m = 0.1;
  result.clear_m = 0.05;
  result.camera_count = 2;
  result.cameras[0] = {.state = CameraState::live, .age_s = 0.02, .without_reading = 0.1, .late = false};
  result.cameras[1] = {.state = CameraState::failed, .age_s = 0.7, .without_reading = 0.2, .late = true};
  result.parts.resize(3);
  const std::vector<ProximityState> states{ProximityState::measured, ProximityState::unobserved,
                                           ProximityState::beyond_rho};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto x = static_cast<double>(i);
    result.parts_world.push_back({{x, 0, 0}, {x, 0, 0.5}, 0.05});
    result.parts[i].nearest.state = states[i];
    result.parts[i].nearest.distance_m = i == 2 ? 0.4 : 0.1 + 0.1 * x;
    result.parts[i].distance_now_m = result.parts[i].nearest.distance_m - 0.03;
    if (i < 2) {
      result.parts[i].on_axis_world = Vector3d(x, 0, 0.25);
      result.parts[i].nearest.nearest_world = Vector3d(x, 0.2, 0.25);
      result.parts[i].nearest.direction_world = Vector3d(0, 1, 0);
    }
  }
  result.parts[0].nearest.camera = 1;
  result.reason.limit = avoidance::MotionLimit::no_images;
  result.reason.part = 1;
  result.reason.camera = 1;
  result.reason.camera_state = CameraState::failed;
  return result;
}

TEST(Ros2Messages, DistancesSayWhatTheAnswerSays) {
  const messages::Header header{.stamp = {.sec = 7, .nanosec = 8}, .frame_id = "world"};
  const messages::Distances message = distances_message(answer(), names(), header);
  EXPECT_EQ(message.header.stamp.sec, 7);
  ASSERT_EQ(message.distances.size(), 3U);
  EXPECT_EQ(message.distances[0].id, "hand");
  EXPECT_NEAR(message.distances[0].distance, 0.1, 1e-12);
  EXPECT_NEAR(message.distances[0].distance_now, 0.07, 1e-12);
  EXPECT_EQ(message.distances[0].camera, "right");
  EXPECT_EQ(message.distances[1].state, static_cast<int>(ProximityState::unobserved));
  EXPECT_EQ(message.distances[1].camera, "") << "none has measured it";
  EXPECT_NE(message.distances[1].reason, "");
  EXPECT_EQ(message.distances[0].reason, "") << "the reason is another part's";
  EXPECT_TRUE(std::isnan(message.distances[2].nearest.x));
  EXPECT_EQ(message.cameras, names().cameras);
  EXPECT_EQ(message.image_ages, (std::vector<double>{0.02, 0.7}));
}

TEST(Ros2Messages, MarkersLeadFromEachPartToWhatIsNearest) {
  const messages::Markers message = markers_message(answer(), names(), {.stamp = {}, .frame_id = "world"});
  int lines = 0;
  int sides = 0;
  int texts = 0;
  for (const messages::Marker& marker : message.markers) {
    EXPECT_EQ(marker.header.frame_id, "world");
    if (marker.type == messages::Marker::line_list) {
      ++lines;
      ASSERT_EQ(marker.points.size(), 4U) << "nothing is near the third part";
      EXPECT_EQ(marker.points[3].x, 1);
      EXPECT_EQ(marker.points[3].y, 0.2);
      ASSERT_EQ(marker.colors.size(), 4U);
      EXPECT_GT(marker.colors[1].b, marker.colors[1].r) << "a surface";
      EXPECT_GT(marker.colors[2].r, marker.colors[2].b) << "unseen";
    }
    if (marker.type == messages::Marker::cylinder) {
      EXPECT_EQ(marker.pose.position.x, sides);
      EXPECT_EQ(marker.pose.position.z, 0.25);
      EXPECT_NEAR(marker.scale.x, 0.1, 1e-12);
      EXPECT_NEAR(marker.scale.z, 0.5, 1e-12);
      ++sides;
    }
    texts += marker.type == messages::Marker::text_view_facing && !marker.text.empty() ? 1 : 0;
  }
  EXPECT_EQ(lines, 1);
  EXPECT_EQ(sides, 3);
  EXPECT_EQ(texts, 1);
  CellAnswer clear = answer();
  for (Answer& part : clear.parts) {
    part.nearest.state = ProximityState::beyond_rho;
  }
  for (const messages::Marker& marker : markers_message(clear, names(), {}).markers) {
    EXPECT_TRUE(marker.type != messages::Marker::line_list || marker.action == messages::Marker::remove);
  }
}

TEST(Ros2Messages, DiagnosticsNameTheCameraThatIsLost) {
  CellAnswer said = answer();
  messages::Diagnostics message = diagnostics_message(said, names(), {});
  ASSERT_EQ(message.status.size(), 3U);
  EXPECT_EQ(message.status[0].level, messages::DiagnosticStatus::error);
  EXPECT_NE(message.status[0].message, "");
  EXPECT_EQ(message.status[1].level, messages::DiagnosticStatus::ok);
  EXPECT_EQ(message.status[2].level, messages::DiagnosticStatus::error);
  EXPECT_THAT(message.status[2].name, HasSubstr("right"));
  EXPECT_THAT(message.status[2].message, HasSubstr("failed"));
  said.stop = false;
  said.cameras[1].state = CameraState::live;
  message = diagnostics_message(said, names(), {});
  EXPECT_EQ(message.status[0].level, messages::DiagnosticStatus::ok);
  EXPECT_EQ(message.status[2].level, messages::DiagnosticStatus::warn) << "its image is late";
}

TEST(Ros2Messages, CameraFramesAreThePosesOfTheRig) {
  Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].id = "left";
  rig.cameras[0].T_world_camera = look_at(Vector3d(1, 2, 3), Vector3d(0, 0, 0.5), Vector3d::UnitZ());
  const messages::Transforms message = camera_frames(rig, {.stamp = {}, .frame_id = "world"});
  ASSERT_EQ(message.transforms.size(), 1U);
  const messages::TransformStamped& frame = message.transforms[0];
  EXPECT_EQ(frame.header.frame_id, "world");
  EXPECT_EQ(frame.child_frame_id, "left");
  const auto& r = frame.transform.rotation;
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).toRotationMatrix();
  T.translation() =
      Vector3d(frame.transform.translation.x, frame.transform.translation.y, frame.transform.translation.z);
  EXPECT_TRUE(T.isApprox(rig.cameras[0].T_world_camera, 1e-12));
}

TEST(Ros2Output, PublishesAnswersAndWhatIsSaidOnce) {
  const int domain = 50 + static_cast<int>(getpid() % 150);
  Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].id = "left";
  const auto output = ros2_output(std::make_shared<dds::Node>(dds::loopback("depthgrid", domain)),
                                  {.names = names(), .rig = rig, .frame = "world", .robot_description = "<robot/>"});
  dds::Node viewer(dds::loopback("viewer", domain));
  using messages::type_of;
  dds::Subscription distances = viewer.subscribe("/distances", type_of<messages::Distances>(), dds::kSensorData);
  dds::Subscription markers = viewer.subscribe("/markers", type_of<messages::Markers>(), dds::kReliable);
  dds::Subscription diagnostics = viewer.subscribe("/diagnostics", type_of<messages::Diagnostics>(), dds::kReliable);
  dds::Subscription frames = viewer.subscribe("/tf_static", type_of<messages::Transforms>(), dds::kLatched);
  dds::Subscription description = viewer.subscribe("/robot_description", type_of<messages::Text>(), dds::kLatched);
  const auto becomes = [](const std::function<bool()>& holds) {
    const double end_s = sensors::clock_now_s() + 20;
    while (!holds() && sensors::clock_now_s() < end_s) {
      usleep(1000);
    }
    return holds();
  };
  ASSERT_TRUE(becomes([&] {
    return distances.publishers() == 1 && markers.publishers() == 1 && diagnostics.publishers() == 1 &&
           frames.publishers() == 1 && description.publishers() == 1;
  }));
  const CellAnswer said = answer();
  for (int n = 0; n < 3; ++n) {
    CellAnswer next = said;
    next.time_s += 1e-3 * n;
    output->take(next);
  }
  std::vector<std::byte> bytes;
  int heard = 0;
  double time_s = 0;
  ASSERT_TRUE(distances.wait(10));
  for (; distances.take(bytes).message; ++heard) {
    const auto message = messages::from_bytes<messages::Distances>(bytes);
    EXPECT_EQ(message.distances.size(), 3U);
    time_s = sensors::clock_time_s(message.header.stamp);
  }
  EXPECT_EQ(heard, 3);
  EXPECT_NEAR(time_s, said.time_s + 2e-3, 1e-4);
  const auto count = [&](dds::Subscription& subscription) {
    int messages = 0;
    while (subscription.take(bytes).message) {
      ++messages;
    }
    return messages;
  };
  EXPECT_EQ(count(markers), 1) << "twenty a second";
  EXPECT_EQ(count(diagnostics), 1) << "one a second";
  EXPECT_EQ(count(frames), 1);
  ASSERT_TRUE(description.take(bytes).message);
  EXPECT_EQ(messages::from_bytes<messages::Text>(bytes).data, "<robot/>");
}

}  // namespace
}  // namespace depthgrid::monitor
