#include "depthgrid/files/mcap_export.hpp"

#include <algorithm>
#include <cstdint>
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
  messages::DepthPixels pixels;
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
      messages::Image image = messages::image_of(view, cameras[k].rule, pixels);
      image.header = header;
      write(topics[k].image, time, image);
    }
  }
  writer.close();
}

}  // namespace depthgrid::files
