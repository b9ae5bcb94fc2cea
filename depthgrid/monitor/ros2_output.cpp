#include "depthgrid/monitor/ros2_output.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/ros2_messages.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"

namespace depthgrid::monitor {
namespace {

using messages::type_of;

/// Says when something is due that is done every so often.
class Every {
 public:
  explicit Every(double period_s) : period_s_(period_s) {}
  [[nodiscard]] bool is_due(double now_s) noexcept {
    if (next_s_ && now_s < *next_s_ && now_s >= *next_s_ - period_s_) {
      return false;
    }
    next_s_ = now_s + period_s_;
    return true;
  }

 private:
  double period_s_;
  std::optional<double> next_s_;
};

class Ros2Output final : public Output {
 public:
  Ros2Output(std::shared_ptr<dds::Node> node, const Ros2OutputSettings& settings)
      : node_(std::move(node)),
        names_(settings.names),
        frame_(settings.frame),
        distances_(node_->publish("distances", type_of<messages::Distances>(), dds::kReliable)),
        markers_(node_->publish("markers", type_of<messages::Markers>(), dds::kReliable)),
        diagnostics_(node_->publish("/diagnostics", type_of<messages::Diagnostics>(), dds::kReliable)),
        frames_(node_->publish("/tf_static", type_of<messages::Transforms>(), dds::kLatched)),
        description_(node_->publish("/robot_description", type_of<messages::Text>(), dds::kLatched)) {
    say(frames_, camera_frames(settings.rig, {.stamp = {}, .frame_id = frame_}));
    if (!settings.robot_description.empty()) {
      say(description_, messages::Text{settings.robot_description});
    }
  }

  void take(const CellAnswer& answer) override {
    const messages::Header header{.stamp = sensors::stamp_of(answer.time_s), .frame_id = frame_};
    messages::Distances distances = distances_message(answer, names_, header);
    tell_basis(answer, sensors::stamp_of, distances);
    say(distances_, distances);
    if (for_markers_.is_due(answer.time_s)) {
      say(markers_, markers_message(answer, names_, header));
    }
    if (for_diagnostics_.is_due(answer.time_s)) {
      say(diagnostics_, diagnostics_message(answer, names_, header));
    }
  }

 private:
  /// What DDS does not take is lost: the next answer says more.
  template <class Message>
  void say(dds::Publisher& publisher, const Message& message) {
    messages::to_bytes(message, bytes_);
    (void)publisher.write(bytes_);
  }

  std::shared_ptr<dds::Node> node_;
  Names names_;
  std::string frame_;
  std::vector<std::byte> bytes_;
  Every for_markers_{0.05};
  Every for_diagnostics_{1.0};
  dds::Publisher distances_;
  dds::Publisher markers_;
  dds::Publisher diagnostics_;
  dds::Publisher frames_;
  dds::Publisher description_;
};

}  // namespace

std::unique_ptr<Output> ros2_output(std::shared_ptr<dds::Node> node, const Ros2OutputSettings& settings) {
  return std::make_unique<Ros2Output>(std::move(node), settings);
}

}  // namespace depthgrid::monitor
