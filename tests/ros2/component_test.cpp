// The component of ROS 2, compiled and run with a stand-in of the client library.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <string>
#include <thread>

#include "depthgrid/core/error.hpp"
#include "files/temporary_folder.hpp"

// What the stand-in's macro makes of the component.
std::unique_ptr<rclcpp::Node> stand_in_component(const rclcpp::NodeOptions& options);

namespace depthgrid {
namespace {

std::string refusal(const rclcpp::NodeOptions& options) {
  try {
    (void)stand_in_component(options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Ros2Component, RefusesToRunWithoutACell) {
  EXPECT_NE(refusal({}).find("parameter cell"), std::string::npos);
  rclcpp::NodeOptions options;
  options.parameters["cell"] = std::string("/nowhere/cell.yaml");
  EXPECT_NE(refusal(options).find("/nowhere/cell.yaml"), std::string::npos);
}

TEST(Ros2Component, TellsOfOutputsThatItDoesNotWrite) {
  const test::TemporaryFolder folder;
  std::ifstream example(DEPTHGRID_SOURCE "/examples/simulated_cell.yaml");
  std::string text{std::istreambuf_iterator<char>(example), {}};
  text.replace(text.find("outputs:\n"), 9, "outputs:\n  prometheus: cell.prom\n  record: run.mcap\n");
  rclcpp::NodeOptions options;
  options.parameters["cell"] = folder.write("cell.yaml", text).string();
  options.parameters["publish"] = false;
  const std::unique_ptr<rclcpp::Node> node = stand_in_component(options);
  EXPECT_TRUE(std::any_of(options.log->begin(), options.log->end(), [](const std::string& line) {
    return line.find("outputs: prometheus: ") != std::string::npos &&
           line.find("cell.prom is not written") != std::string::npos;
  }));
  EXPECT_TRUE(std::filesystem::exists(folder / "run.mcap"));
}

TEST(Ros2Component, RunsTheSimulatedCellAndTellsWhatHappens) {
  rclcpp::NodeOptions options;
  options.parameters["cell"] = std::string(DEPTHGRID_SOURCE "/examples/simulated_cell.yaml");
  options.parameters["publish"] = false;
  const std::unique_ptr<rclcpp::Node> node = stand_in_component(options);
  ASSERT_EQ(node->timers.size(), 1U);
  const auto is_told = [&](const std::string& words) {
    return std::any_of(options.log->begin(), options.log->end(),
                       [&](const std::string& line) { return line.find(words) != std::string::npos; });
  };
  for (int i = 0; i < 100 && !is_told("open"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    node->timers.front().lock()->callback();
  }
  EXPECT_TRUE(is_told("front")) << "no camera was opened";
  EXPECT_TRUE(is_told("open"));
}

}  // namespace
}  // namespace depthgrid
