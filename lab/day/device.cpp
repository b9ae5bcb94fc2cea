#include "lab/day/device.hpp"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <optional>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/dds/node.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"
#include "depthgrid/sensors/simulated_camera.hpp"
#include "depthgrid/sensors/simulated_joints.hpp"
#include "lab/day/faulty_messages.hpp"
#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {
namespace {

using messages::type_of;

/// The device's own faults, in the order of time, and the one that holds.
class OwnFaults {
 public:
  OwnFaults(const std::string& device, const DayPlan& plan) {
    std::copy_if(plan.faults.begin(), plan.faults.end(), std::back_inserter(faults_),
                 [&](const PlannedFault& fault) { return fault.device == device; });
  }
  /// Null: none. Times do not go back.
  const PlannedFault* at(double cell_s) {
    while (next_ < faults_.size() && faults_[next_].end_s <= cell_s) {
      ++next_;
    }
    return next_ < faults_.size() && faults_[next_].begin_s <= cell_s ? &faults_[next_] : nullptr;
  }

 private:
  std::vector<PlannedFault> faults_;
  std::size_t next_ = 0;
};

/// A line at each beginning and end of a fault, with what was measured first then.
class DeviceLog {
 public:
  DeviceLog(const std::filesystem::path& file, std::string device) : device_(std::move(device)) {
    if (!file.empty()) {
      out_.open(file, std::ios::app);
      if (!out_) {
        fail(file.string(), ": cannot be written");
      }
    }
  }
  void tell(const PlannedFault* fault, double cell_s, std::size_t sent) {
    const bool is_first = fault != before_ || !has_told_;
    if (out_.is_open() && is_first) {
      Json line;
      line["device"] = device_;
      line["measured_s"] = cell_s;
      line["fault"] = fault != nullptr ? Json(std::string(to_string(fault->fault))) : Json(nullptr);
      line["sent"] = sent;
      out_ << line.dump() + "\n" << std::flush;
    }
    before_ = fault;
    has_told_ = true;
  }

 private:
  std::string device_;
  std::ofstream out_;
  const PlannedFault* before_ = nullptr;
  bool has_told_ = false;
};

/// A node with the topics of one device; it leaves the network and comes back.
class Driver {
 public:
  Driver(std::string device, const cell::Cell& cell, const cell::CellSetup& setup)
      : device_(std::move(device)), domain_(cell.ros2.domain) {
    if (device_ == kJointsDevice) {
      if (!cell.robot) {
        fail("the cell has no robot whose joints could be sent");
      }
      topic_ = cell.robot->joints.topic;
      for (const robot::Joint& joint : setup.robot->model.joints()) {
        joints_.push_back(joint.name);
      }
    } else {
      const auto found = std::find_if(cell.cameras.begin(), cell.cameras.end(),
                                      [&](const cell::CameraEntry& camera) { return camera.name == device_; });
      if (found == cell.cameras.end()) {
        fail("the cell has no camera '", device_, "'");
      }
      topic_ = found->device;
      camera_ = setup.rig.cameras[static_cast<std::size_t>(found - cell.cameras.begin())];
    }
    if (topic_.empty()) {
      fail(device_, ": the cell names no topic: source: ros2");
    }
    plug_in();
  }

  void plug_in() {
    if (node_) {
      return;
    }
    node_.emplace(
        dds::NodeSettings{.name = "device_" + device_, .name_space = "/", .domain = domain_, .configuration = {}});
    if (device_ == kJointsDevice) {
      out_.emplace(node_->publish(topic_, type_of<messages::JointState>(), dds::kReliable));
      return;
    }
    out_.emplace(node_->publish(topic_, type_of<messages::Image>(), dds::kReliable));
    info_.emplace(node_->publish(topic_.substr(0, topic_.rfind('/') + 1) + "camera_info",
                                 type_of<messages::CameraInfo>(), dds::kReliable));
  }
  void unplug() {
    info_.reset();
    out_.reset();
    node_.reset();
  }

  /// False: DDS did not take it.
  bool send(const DeviceMessage& message) {
    if (!node_) {
      return false;
    }
    messages::Header header;
    header.stamp = sensors::stamp_of(message.time_s);
    if (device_ == kJointsDevice) {
      messages::JointState state;
      state.header = header;
      state.name.assign(joints_.begin(), joints_.begin() + static_cast<std::ptrdiff_t>(message.q.size()));
      state.position = message.q;
      return out_->write(messages::to_bytes(state));
    }
    header.frame_id = device_;
    (void)info_->write(messages::to_bytes(messages::camera_info({camera_->intrinsics, {}}, header)));
    messages::Image image;
    image.header = header;
    image.width = static_cast<std::uint32_t>(message.width_px);
    image.height = static_cast<std::uint32_t>(message.height_px);
    image.step = 2 * image.width;
    image.encoding = "16UC1";
    image.data = std::as_bytes(std::span(message.units));
    messages::to_bytes(image, bytes_);
    return out_->write(bytes_);
  }

 private:
  std::string device_;
  int domain_;
  std::string topic_;
  std::vector<std::string> joints_;
  std::optional<RigCamera> camera_;
  std::optional<dds::Node> node_;
  std::optional<dds::Publisher> out_;
  std::optional<dds::Publisher> info_;
  std::vector<std::byte> bytes_;
};

/// What a device measures, one after the other.
class Measuring {
 public:
  virtual ~Measuring() = default;
  /// False: nothing within the time.
  virtual bool next(DeviceMessage& message, double longest_s) = 0;
};

class MeasuredImages final : public Measuring {
 public:
  MeasuredImages(const std::shared_ptr<const sensors::SimulatedCell>& simulated, const RigCamera& camera,
                 double rate_hz, std::uint64_t unit)
      : camera_(simulated, camera, rate_hz, unit) {
    camera_.open();
  }
  bool next(DeviceMessage& message, double longest_s) override {
    sensors::DepthReading reading;
    if (camera_.next(reading, longest_s) != sensors::Reading::got) {
      return false;
    }
    const auto* const units = static_cast<const std::uint16_t*>(reading.depth.data);
    message.time_s = reading.time_s;
    message.width_px = reading.depth.width_px;
    message.height_px = reading.depth.height_px;
    message.units.assign(units, units + std::ptrdiff_t{message.width_px} * message.height_px);
    return true;
  }

 private:
  sensors::SimulatedCamera camera_;
};

/// Rendered ahead, and sent in turn at the rate: what a camera costs its computer is not measured then.
class RenderedImages final : public Measuring {
 public:
  RenderedImages(const sensors::SimulatedCell& simulated, const RigCamera& camera, double rate_hz, std::uint64_t unit,
                 int count)
      : period_s_(1 / rate_hz), phase_s_(period_s_ * 0.5 * static_cast<double>(unit % 2)) {
    simulation::SimulatedSensor sensor(
        simulation::sensor_simulation(camera.sensor.empty() ? "ideal" : camera.sensor, camera.intrinsics),
        camera.intrinsics, unit + 1);
    DepthImage measured_m;
    for (int n = 0; n < count; ++n) {
      sensor.measure(simulated.scene_at(n * period_s_).render(camera.intrinsics, camera.T_world_camera).depth_m,
                     static_cast<std::uint64_t>(n), measured_m);
      DeviceMessage& image = images_.emplace_back();
      image.width_px = camera.intrinsics.width_px;
      image.height_px = camera.intrinsics.height_px;
      image.units = simulation::in_units(measured_m, camera.metres_per_unit);
    }
    image_ = static_cast<std::int64_t>(sensors::clock_now_s() / period_s_) + 1;
  }
  bool next(DeviceMessage& message, double longest_s) override {
    const double due_s = static_cast<double>(image_) * period_s_ + phase_s_;
    if (!sensors::wait_until(due_s, longest_s)) {
      return false;
    }
    message = images_[static_cast<std::size_t>(image_) % images_.size()];
    message.time_s = due_s;
    image_ = std::max(image_ + 1, static_cast<std::int64_t>((sensors::clock_now_s() - phase_s_) / period_s_));
    return true;
  }

 private:
  double period_s_;
  double phase_s_;
  std::vector<DeviceMessage> images_;
  std::int64_t image_ = 0;
};

class MeasuredJoints final : public Measuring {
 public:
  MeasuredJoints(const std::shared_ptr<const sensors::SimulatedCell>& simulated, double rate_hz)
      : joints_(simulated, rate_hz) {
    joints_.open();
  }
  bool next(DeviceMessage& message, double longest_s) override {
    sensors::JointReading reading;
    if (joints_.next(reading, longest_s) != sensors::Reading::got) {
      return false;
    }
    message.time_s = reading.time_s;
    message.q.assign(reading.q.begin(), reading.q.end());
    return true;
  }

 private:
  sensors::SimulatedJoints joints_;
};

std::unique_ptr<Measuring> measuring(const std::string& device, const cell::Cell& cell, const cell::CellSetup& setup,
                                     const std::shared_ptr<const sensors::SimulatedCell>& simulated,
                                     const DeviceSettings& settings) {
  if (device == kJointsDevice) {
    return std::make_unique<MeasuredJoints>(simulated, settings.plan.joint_rate_hz);
  }
  std::size_t unit = 0;
  while (unit + 1 < cell.cameras.size() && cell.cameras[unit].name != device) {
    ++unit;
  }
  const RigCamera& camera = setup.rig.cameras[unit];
  if (settings.rendered_ahead > 0) {
    return std::make_unique<RenderedImages>(*simulated, camera, settings.plan.image_rate_hz, unit,
                                            settings.rendered_ahead);
  }
  return std::make_unique<MeasuredImages>(simulated, camera, settings.plan.image_rate_hz, unit);
}

}  // namespace

void run_device(const std::string& device, const cell::Cell& cell, const cell::CellSetup& setup,
                const std::shared_ptr<const sensors::SimulatedCell>& simulated, const DeviceSettings& settings,
                const std::atomic<bool>& is_over) {
  constexpr double kSlice_s = 0.05;
  Driver driver(device, cell, setup);
  OwnFaults faults(device, settings.plan);
  DeviceLog log(settings.log, device);
  const double late_s = 0.2 + (device == kJointsDevice ? cell.ages.joints_s : cell.ages.image_s);
  FaultyMessages faulty(late_s);
  const std::unique_ptr<Measuring> source = measuring(device, cell, setup, simulated, settings);
  const PlannedFault* before = nullptr;
  DeviceMessage message;
  while (!is_over && sensors::clock_now_s() < simulated->begin_s() + settings.plan.seconds) {
    if (!source->next(message, kSlice_s)) {
      continue;
    }
    const double cell_s = message.time_s - simulated->begin_s();
    const PlannedFault* const fault = faults.at(cell_s);
    const bool begins = fault != nullptr && fault != before;
    before = fault;
    if (begins && (fault->fault == DeviceFault::unplug || fault->fault == DeviceFault::restart)) {
      driver.unplug();
    }
    if (fault == nullptr || fault->fault != DeviceFault::unplug) {
      driver.plug_in();
    }
    std::size_t sent = 0;
    message.time_s += settings.clock_ahead_s;
    for (const DeviceMessage& out : faulty.pass(message, fault != nullptr ? std::optional(fault->fault) : std::nullopt,
                                                sensors::clock_now_s() + settings.clock_ahead_s)) {
      sent += driver.send(out) ? 1 : 0;
    }
    log.tell(fault, cell_s, sent);
  }
}

}  // namespace depthgrid::lab
