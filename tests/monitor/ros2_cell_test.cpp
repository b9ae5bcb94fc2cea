// A cell whose cameras and joints are topics of another node, and whose answers are topics again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dds/loopback.hpp"
#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/monitor/ros2_output.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"
#include "depthgrid/sensors/simulated_camera.hpp"
#include "depthgrid/sensors/simulated_joints.hpp"

namespace depthgrid::monitor {
namespace {

using messages::type_of;

int domain() { return 50 + static_cast<int>(getpid() % 150); }

std::string ros2_cell() {
  return R"(name: ros2
smallest_obstacle_m: 0
cameras:
  - name: front
    source: ros2
    topic: /front/depth/image_raw
    intrinsics: {width_px: 64, height_px: 48, fx_px: 48, fy_px: 48, cx_px: 31.5, cy_px: 23.5}
    pose: {position_m: [2.3, -1.6, 1.4], look_at_m: [0, -0.1, 0.4]}
    sensor: kinect_v1
  - name: back
    source: ros2
    topic: /back/depth/image_raw
    intrinsics: {width_px: 64, height_px: 48, fx_px: 48, fy_px: 48, cx_px: 31.5, cy_px: 23.5}
    pose: {position_m: [-2.3, -1.5, 1.4], look_at_m: [0, -0.1, 0.4]}
    sensor: kinect_v1
robot:
  urdf: kuka_lwr4
  base: {position_m: [0, 0, 0]}
  joints: {source: ros2, topic: /joint_states, time_error_s: 0.005}
  padding_m: 0.1
space: {low_m: [-1.4, -1.4, -0.4], high_m: [1.4, 1.4, 1.4]}
policies: {unobserved: obstacle, outside: ignored, robot_pockets: ignored, ignored_pocket_m: 0.1}
v_max_m_s: 1.6
memory: none
ask: {rate_hz: 50, links: moving, rho_m: 0.6, resolution_m: 0.02}
ages: {image_s: 0.35, joints_s: 0.25}
outputs: {ros2: true, terminal: false}
ros2: {node: depthgrid, namespace: /cell, domain: )" +
         std::to_string(domain()) + ", frame: base}\n";
}

/// The driver's node: simulated cameras and joints, each in a thread.
class Driver {
 public:
  explicit Driver(const cell::CellSetup& setup) : node_(dds::loopback("driver", domain())) {
    sensors::SimulatedCellSettings scene;
    scene.robot = setup.robot;
    const auto simulated = std::make_shared<const sensors::SimulatedCell>(scene);
    const std::array<std::string, 2> topics{"/front/depth/image_raw", "/back/depth/image_raw"};
    for (std::size_t k = 0; k < 2; ++k) {
      threads_.emplace_back([this, k, camera = setup.rig.cameras[k], simulated, topic = topics.at(k)] {
        send_images(k, sensors::SimulatedCamera(simulated, camera, 15, k), topic);
      });
    }
    std::vector<std::string> names;
    for (const robot::Joint& joint : setup.robot->model.joints()) {
      names.push_back(joint.name);
    }
    threads_.emplace_back([this, names, simulated] { send_joints(sensors::SimulatedJoints(simulated, 100), names); });
  }
  ~Driver() {
    is_over_ = true;
    for (std::thread& thread : threads_) {
      thread.join();
    }
  }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  std::array<std::atomic<bool>, 2> holds_back{};  ///< a camera's images

 private:
  void send_images(std::size_t k, sensors::SimulatedCamera&& camera, const std::string& topic) {
    dds::Publisher images = node_.publish(topic, type_of<messages::Image>(), dds::kReliable);
    camera.open();
    sensors::DepthReading reading;
    while (!is_over_) {
      if (camera.next(reading, 0.05) != sensors::Reading::got || holds_back.at(k)) {
        continue;
      }
      const DepthView& depth = reading.depth;
      messages::Image image;
      image.header.stamp = sensors::stamp_of(reading.time_s);
      image.width = static_cast<std::uint32_t>(depth.width_px);
      image.height = static_cast<std::uint32_t>(depth.height_px);
      image.step = 2 * image.width;
      image.encoding = "16UC1";
      image.data = {static_cast<const std::byte*>(depth.data), std::size_t{image.step} * image.height};
      (void)images.write(messages::to_bytes(image));
    }
  }
  void send_joints(sensors::SimulatedJoints&& joints, const std::vector<std::string>& names) {
    dds::Publisher states = node_.publish("/joint_states", type_of<messages::JointState>(), dds::kReliable);
    joints.open();
    sensors::JointReading reading;
    while (!is_over_) {
      if (joints.next(reading, 0.05) == sensors::Reading::got) {
        messages::JointState state;
        state.header.stamp = sensors::stamp_of(reading.time_s);
        state.name = names;
        state.position.assign(reading.q.begin(), reading.q.end());
        (void)states.write(messages::to_bytes(state));
      }
    }
  }

  dds::Node node_;
  std::atomic<bool> is_over_{false};
  std::vector<std::thread> threads_;
};

TEST(Ros2Cell, AnswersFromTopicsAndSaysWhichCameraIsSilent) {
  const cell::Cell cell = cell::parse_cell(ros2_cell(), "ros2.yaml");
  const cell::CellSetup setup = cell::setup(cell);
  Driver driver(setup);
  const auto node = ros2_node(cell);
  ASSERT_NE(node, nullptr);
  Monitor monitor(setup, monitor_settings(cell), make_sources(cell, setup, node));
  monitor.add(ros2_output(cell, setup, monitor.names(), node));
  dds::Node viewer(dds::loopback("viewer", domain()));
  dds::Subscription heard = viewer.subscribe("/cell/distances", type_of<messages::Distances>(), dds::kSensorData);
  monitor.start();
  std::vector<std::byte> bytes;
  messages::Distances newest;
  const auto becomes = [&](const std::function<bool(const messages::Distances&)>& holds) {
    const double end_s = sensors::clock_now_s() + 30;
    while (sensors::clock_now_s() < end_s) {
      if (heard.wait(0.1) && heard.take(bytes).message) {
        newest = messages::from_bytes<messages::Distances>(bytes);
        if (holds(newest)) {
          return true;
        }
      }
    }
    return false;
  };
  const auto is_well = [](const messages::Distances& now) {
    return now.image_ages.size() == 2 && now.image_ages[0] < 0.35 && now.image_ages[1] < 0.35 &&
           !now.distances.empty() && std::isfinite(now.distances[0].distance_now) && !now.distances[0].stale;
  };
  ASSERT_TRUE(becomes(is_well));
  EXPECT_EQ(newest.header.frame_id, "base");
  EXPECT_EQ(newest.cameras, (std::vector<std::string>{"front", "back"}));
  EXPECT_EQ(newest.distances.size(), monitor.names().parts.size());
  EXPECT_NEAR(sensors::clock_time_s(newest.header.stamp), sensors::clock_now_s(), 1.0);

  driver.holds_back[0] = true;
  std::string said;
  EXPECT_TRUE(becomes([&](const messages::Distances& now) {
    for (const messages::Distance& part : now.distances) {
      said = part.reason.empty() ? said : part.reason;
    }
    return said.find("camera front is silent, its image is ") != std::string::npos && now.image_ages[0] > 0.35;
  })) << said;
  driver.holds_back[0] = false;
  EXPECT_TRUE(becomes(is_well));
  monitor.stop();
}

TEST(Ros2Cell, WithoutTopicsHasNoNode) {
  std::string text = ros2_cell();
  const auto replace = [&](const std::string& what, const std::string& by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
      text.replace(at, what.size(), by);
    }
  };
  replace("    topic: /front/depth/image_raw\n", "");
  replace("    topic: /back/depth/image_raw\n", "");
  replace("source: ros2, topic: /joint_states", "source: simulated");
  replace("source: ros2", "source: simulated");
  EXPECT_NE(ros2_node(cell::parse_cell(text, "a.yaml")), nullptr) << "its answers are topics";
  replace("ros2: true, ", "");
  EXPECT_EQ(ros2_node(cell::parse_cell(text, "a.yaml")), nullptr);
}

}  // namespace
}  // namespace depthgrid::monitor
