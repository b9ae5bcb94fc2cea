// A robot cell as a component of ROS 2: what `depthgrid run` does, with name, namespace, domain and log of this node.
//
// Parameters, read once:
//   cell       string   the cell file; depthgrid cell new writes one
//   publish    bool     true: distances, markers, diagnostics and frames as topics, whatever the file's outputs say
//
// Cameras and joints are those of the cell file. Its topics, and those of the answers, go through a node of depthgrid's
// own in this process, which is called as this one is, with _dds behind it, and is in the same domain and namespace.
#include <chrono>
#include <filesystem>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
#include <string>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/monitor/open_cell.hpp"

namespace depthgrid_ros {

class CellComponent : public rclcpp::Node {
 public:
  /// Throws depthgrid::Error with the file, the place and the way out.
  explicit CellComponent(const rclcpp::NodeOptions& options) : rclcpp::Node("cell", options) {
    const auto file = declare_parameter<std::string>("cell", "");
    if (file.empty()) {
      throw depthgrid::Error("parameter cell: names no cell file; ros2 launch depthgrid_ros cell.launch.py cell:=FILE");
    }
    depthgrid::cell::Cell cell = depthgrid::cell::load_cell(file);
    cell.outputs.ros2 = declare_parameter<bool>("publish", true);
    cell.ros2.node = std::string(get_name()) + "_dds";
    cell.ros2.name_space = get_namespace();
    cell.ros2.domain = static_cast<int>(get_node_base_interface()->get_context()->get_domain_id());
    const depthgrid::cell::CellSetup setup = depthgrid::cell::setup(cell);
    for (const std::string& line : depthgrid::cell::implausible(cell, setup)) {
      RCLCPP_WARN(get_logger(), "%s", line.c_str());
    }
    const auto topics = depthgrid::monitor::ros2_node(cell);
    monitor_ = std::make_unique<depthgrid::monitor::Monitor>(setup, depthgrid::monitor::monitor_settings(cell),
                                                             depthgrid::monitor::make_sources(cell, setup, topics));
    if (cell.outputs.ros2) {
      monitor_->add(depthgrid::monitor::ros2_output(cell, setup, monitor_->names(), topics));
    }
    if (cell.outputs.udp) {
      monitor_->add(depthgrid::monitor::udp_output(*cell.outputs.udp));
    }
    if (!cell.outputs.record.empty()) {
      monitor_->record(depthgrid::monitor::recorder(cell, setup, monitor_->names()));
    }
    tell_unwritten("jsonl", cell.outputs.jsonl);
    tell_unwritten("log", cell.outputs.log);
    tell_unwritten("prometheus", cell.outputs.prometheus);
    monitor_->start();
    timer_ = create_wall_timer(std::chrono::milliseconds(100), [this] { tell(); });
  }

 private:
  void tell_unwritten(const char* key, const std::filesystem::path& output) {
    if (!output.empty()) {
      const std::string line =
          std::string("outputs: ") + key + ": " + output.string() + " is not written: " + "depthgrid run writes it";
      RCLCPP_WARN(get_logger(), "%s", line.c_str());
    }
  }
  void tell() {
    for (const depthgrid::monitor::Event& event : monitor_->events()) {
      const std::string line = depthgrid::monitor::event_line(event, monitor_->names());
      if (event.kind == depthgrid::monitor::EventKind::source_failed) {
        RCLCPP_ERROR(get_logger(), "%s", line.c_str());
      } else {
        RCLCPP_INFO(get_logger(), "%s", line.c_str());
      }
    }
  }

  std::unique_ptr<depthgrid::monitor::Monitor> monitor_;
  rclcpp::TimerBase::SharedPtr timer_;  ///< ends before what it tells of
};

}  // namespace depthgrid_ros

RCLCPP_COMPONENTS_REGISTER_NODE(depthgrid_ros::CellComponent)
