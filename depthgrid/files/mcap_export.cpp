#include "depthgrid/files/mcap_export.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/messages/serialization.hpp"

namespace depthgrid::files {
namespace {

/// What is written of one camera.
struct Topics {
  std::uint16_t image = 0;
  std::uint16_t info = 0;
  std::string frame_id;
};

void check_id(const std::string& id) {
  const auto may_stand = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/';
  };
  if (!std::all_of(id.begin(), id.end(), may_stand)) {
    fail("camera '", id, "': its id cannot be the name of a topic, which has letters, digits, _ and / only");
  }
}

messages::TransformStamped place_of(const RigCamera& camera, const std::string& frame_id, const messages::Time& time) {
  const Eigen::Vector3d t = camera.T_world_camera.translation();
  const Eigen::Quaterniond q(camera.T_world_camera.linear());
  messages::TransformStamped stamped;
  stamped.header = {.stamp = time, .frame_id = "world"};
  stamped.child_frame_id = frame_id;
  stamped.transform.translation = {.x = t.x(), .y = t.y(), .z = t.z()};
  stamped.transform.rotation = {.x = q.x(), .y = q.y(), .z = q.z(), .w = q.w()};
  return stamped;
}

/// One camera's pixels, in memory that is used again.
class ImageMessage {
 public:
  /// A view of `view` or of this.
  messages::Image make(const DepthView& view, const RigCamera& camera, messages::Header header) {
    messages::Image image;
    image.header = std::move(header);
    image.width = static_cast<std::uint32_t>(view.width_px);
    image.height = static_cast<std::uint32_t>(view.height_px);
    MeasurementRule rule;
    rule.invalid_units = camera.rule.invalid_units;
    if (view.format == DepthFormat::uint16_units && view.metres_per_unit == messages::kMetresPerUnit) {
      units_.clear();
      each_pixel(view, [&](int u, int v) {
        const bool measured = measured_depth_m(view, rule, u, v).has_value();
        units_.push_back(measured ? pixel(view, u, v) : std::uint16_t{0});
      });
      image.encoding = "16UC1";
      image.step = image.width * static_cast<std::uint32_t>(sizeof(std::uint16_t));
      image.data = std::as_bytes(std::span(units_));
    } else {
      metres_.clear();
      each_pixel(view, [&](int u, int v) {
        metres_.push_back(measured_depth_m(view, rule, u, v).value_or(std::numeric_limits<float>::quiet_NaN()));
      });
      image.encoding = "32FC1";
      image.step = image.width * static_cast<std::uint32_t>(sizeof(float));
      image.data = std::as_bytes(std::span(metres_));
    }
    return image;
  }

 private:
  template <class Action>
  static void each_pixel(const DepthView& view, const Action& action) {
    for (int v = 0; v < view.height_px; ++v) {
      for (int u = 0; u < view.width_px; ++u) {
        action(u, v);
      }
    }
  }
  static std::uint16_t pixel(const DepthView& view, int u, int v) {
    const auto* row = static_cast<const std::byte*>(view.data) + v * view.stride_bytes;
    return reinterpret_cast<const std::uint16_t*>(row)[u];
  }

  std::vector<std::uint16_t> units_;
  std::vector<float> metres_;
};

}  // namespace

void save_mcap(Recording& recording, const std::filesystem::path& file, const McapWriterOptions& options) {
  const std::vector<RigCamera>& cameras = recording.rig().cameras;
  if (recording.moves()) {
    fail(recording.rig_file().string(), ": a camera moves, and only cameras that stand are written to MCAP files");
  }
  for (const RigCamera& camera : cameras) {
    check_id(camera.id);
  }
  McapWriter writer(file, options);
  std::vector<Topics> topics;
  const std::uint16_t tf = writer.add_channel("/tf_static", messages::type_of<messages::Transforms>(), true);
  const messages::Time first = messages::time_of(recording.stamp_s(0, 0));
  messages::Transforms places;
  for (const RigCamera& camera : cameras) {
    const std::string name = "/" + camera.id + "/depth";
    topics.push_back({.image = writer.add_channel(name + "/image_raw", messages::type_of<messages::Image>()),
                      .info = writer.add_channel(name + "/camera_info", messages::type_of<messages::CameraInfo>()),
                      .frame_id = camera.id + "_depth_optical_frame"});
    places.transforms.push_back(place_of(camera, topics.back().frame_id, first));
  }
  std::vector<std::byte> bytes;
  const auto write = [&](std::uint16_t channel, const messages::Time& time, const auto& message) {
    const auto time_ns = static_cast<std::uint64_t>(messages::nanoseconds(time));
    to_bytes(message, bytes);
    writer.write(channel, time_ns, time_ns, bytes);
  };
  write(tf, first, places);
  ImageMessage image;
  for (int index = 0; index < recording.frame_count(); ++index) {
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      if (!recording.has_image(index, k)) {
        continue;
      }
      const DepthView view = recording.read_recorded(index, k);
      const messages::Time time = messages::time_of(recording.stamp_s(index, k));
      const messages::Header header{.stamp = time, .frame_id = topics[k].frame_id};
      const messages::CameraModel model{.intrinsics = recording.recorded_intrinsics(k),
                                        .distortion = recording.recorded_distortion(k)};
      write(topics[k].info, time, messages::camera_info(model, header));
      write(topics[k].image, time, image.make(view, cameras[k], header));
    }
  }
  writer.close();
}

}  // namespace depthgrid::files
