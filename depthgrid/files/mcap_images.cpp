#include "depthgrid/files/mcap_images.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/rig_selection.hpp"
#include "depthgrid/files/transform_tree.hpp"
#include "depthgrid/messages/serialization.hpp"

namespace depthgrid::files {
namespace {

constexpr std::string_view kImage = "sensor_msgs/msg/Image";
constexpr std::string_view kCompressedImage = "sensor_msgs/msg/CompressedImage";
constexpr std::string_view kCameraInfo = "sensor_msgs/msg/CameraInfo";
constexpr std::string_view kTransforms = "tf2_msgs/msg/TFMessage";
constexpr std::string_view kCompressedDepth = "/compressedDepth";

std::string in_quotes(std::string_view text) { return "'" + printable_excerpt(text) + "'"; }

/// The topic that image_transport made a compressed one of.
std::string_view base_topic(std::string_view topic) {
  return topic.ends_with(kCompressedDepth) ? topic.substr(0, topic.size() - kCompressedDepth.size()) : topic;
}

std::string_view parent_of(std::string_view topic) { return topic.substr(0, std::min(topic.rfind('/'), topic.size())); }

/// Of images without distortion image_proc says so in the topic's name.
bool is_rectified(std::string_view topic) {
  const std::string_view base = base_topic(topic);
  return base.substr(parent_of(base).size()).starts_with("/image_rect");
}

/// "/left/depth/image_raw": "left".
std::string camera_id_of(std::string_view topic) {
  std::string_view id = parent_of(base_topic(topic));
  if (id.ends_with("/depth")) {
    id = parent_of(id);
  }
  if (id.size() < 2) {
    id = topic;
  }
  return std::string(id.starts_with('/') ? id.substr(1) : id);
}

std::string id_and_topic(const std::string& given, std::string& topic) {
  const std::size_t at = given.find('=');
  topic = at == std::string::npos ? given : given.substr(at + 1);
  return at == std::string::npos ? camera_id_of(topic) : given.substr(0, at);
}

bool same_calibration(const messages::CameraInfo& a, const messages::CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model && a.d == b.d &&
         a.k == b.k && a.p == b.p && a.r == b.r && a.binning_x == b.binning_x && a.binning_y == b.binning_y &&
         a.roi.x_offset == b.roi.x_offset && a.roi.y_offset == b.roi.y_offset;
}

/// The view's pixels in memory that the next message leaves alone.
DepthView copied(const DepthView& view, messages::DepthPixels& pixels) {
  const auto count = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  const auto row = static_cast<std::size_t>(row_bytes(view.format, view.width_px));
  const auto copy_rows = [&](auto& own) {
    own.resize(count);
    for (int v = 0; v < view.height_px; ++v) {
      std::memcpy(own.data() + static_cast<std::ptrdiff_t>(v) * view.width_px,
                  static_cast<const std::byte*>(view.data) + v * view.stride_bytes, row);
    }
  };
  if (view.format == DepthFormat::uint16_units) {
    if (view.data != pixels.units.data()) {
      copy_rows(pixels.units);
    }
    return depth_view(pixels.units, view.width_px, view.height_px, view.metres_per_unit);
  }
  if (view.data != pixels.metres.data()) {
    copy_rows(pixels.metres);
  }
  return depth_view(pixels.metres, view.width_px, view.height_px);
}

/// Runs it; an Error begins with `where`.
template <class Action>
auto in_context(const std::string& where, const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    fail(where, ": ", error.what());
  }
}

/// What is stated of a camera in place of the file is of one camera.
void check_statement(const McapChoice& choice, std::size_t cameras, const std::string& name) {
  const bool of_one = choice.intrinsics || choice.T_world_camera || !choice.info_topic.empty();
  if (of_one && (cameras != 1 || !choice.rig.empty())) {
    fail_choice(name, ": calibration, place or camera_info is stated of one camera, and ", cameras, " are chosen",
                choice.rig.empty() ? "" : ", with a rig file");
  }
}

}  // namespace

McapImages::McapImages(const std::filesystem::path& file, const McapChoice& choice,
                       const std::vector<std::string>& camera_ids)
    : name_(file.string()), reader_(file) {
  std::vector<Topic> found = find_topics(choice);
  if (choice.rig.empty()) {
    for (const Topic& topic : found) {
      RigCamera camera;
      camera.id = topic.camera_id;
      rig_file_.rig.cameras.push_back(std::move(camera));
      rig_file_.depth_files.emplace_back();
    }
    rig_file_ = select_cameras(std::move(rig_file_), camera_ids, name_);
  } else {
    rig_file_ = select_cameras(load_rig(choice.rig), camera_ids, choice.rig.string());
  }
  for (const RigCamera& camera : rig_file_.rig.cameras) {
    const auto topic =
        std::find_if(found.begin(), found.end(), [&](const Topic& t) { return t.camera_id == camera.id; });
    if (topic == found.end()) {
      fail_choice(choice.rig.string(), ": camera ", in_quotes(camera.id), " has no images in ", name_,
                  ": name its topic, ", camera.id, "=TOPIC, or leave the camera out; topics: ", list_of_topics());
    }
    topics_.push_back(*topic);
    read_stamps(topics_.back());
  }
  if (choice.rig.empty()) {
    rig_file_.rig.name = printable(file.stem().string());
    for (std::size_t k = 0; k < topics_.size(); ++k) {
      rig_file_.rig.cameras[k] = camera_of(topics_[k], choice);
    }
    if (choice.T_world_camera) {
      rig_file_.rig.cameras.front().T_world_camera = *choice.T_world_camera;
    } else {
      place_cameras(choice);
    }
    validate(rig_file_.rig);
  }
  check_statement(choice, topics_.size(), name_);
  rig_file_.count_stated = false;
  rig_file_.simultaneous = true;  // what the time stamps say
  rig_file_.rate_hz.reset();
  for (const CameraTrack& track : rig_file_.tracks) {
    if (!track.pose_files.empty()) {
      fail(choice.rig.string(), ": pose_files go by numbers, and the images of ", name_,
           " have time stamps; give a trajectory");
    }
  }
  if (choice.tolerance_s) {
    rig_file_.tolerance_s = choice.tolerance_s;
  }
  if (topics_.size() > 1 && !rig_file_.tolerance_s) {
    fail_choice(name_, ": has ", topics_.size(),
                " cameras, and nothing says how far apart, in seconds, images of one frame may be: --tolerance, or "
                "tolerance_s of the rig file");
  }
  for (const Topic& topic : topics_) {
    notes_.push_back(name_ + ": camera " + in_quotes(topic.camera_id) + ": " + std::to_string(topic.images.size()) +
                     " images of " + topic.channel->topic);
  }
  if (!reader_.damage().empty()) {
    notes_.push_back(name_ + ": " + reader_.damage());
  }
}

std::string McapImages::list_of_topics() {
  std::string text;
  for (const McapChannel& channel : reader_.channels()) {
    text +=
        (text.empty() ? "" : ", ") + printable_excerpt(channel.topic) + " (" + printable_excerpt(channel.type) + ")";
  }
  return text.empty() ? "none" : text;
}

/// Throws Error that says why it does not.
void McapImages::check_depth(const McapChannel& channel) {
  const std::string where = name_ + ": topic " + in_quotes(channel.topic);
  if (channel.type != kImage && channel.type != kCompressedImage) {
    fail(where, " holds ", channel.type.empty() ? "messages of no stated type" : printable_excerpt(channel.type),
         ", no images; topics: ", list_of_topics());
  }
  if (channel.encoding != "cdr") {
    fail(where, " has messages in the encoding ", in_quotes(channel.encoding), ", must be cdr, as ROS 2 records");
  }
  const std::vector<McapEntry> entries = reader_.entries(reader_.same_as(channel));
  if (entries.empty()) {
    fail(where, " has no messages");
  }
  in_context(where, [&] {
    const McapMessage message = reader_.read(entries.front());
    if (channel.type == kCompressedImage) {
      static_cast<void>(compressed_depth(messages::from_bytes<messages::CompressedImage>(message.data)));
    } else {
      messages::DepthPixels pixels;
      static_cast<void>(depth_view(messages::from_bytes<messages::Image>(message.data), pixels));
    }
  });
}

/// mono16 is more often infrared.
bool McapImages::holds_depth(const McapChannel& channel) {
  if (channel.encoding != "cdr" || (channel.type != kImage && channel.type != kCompressedImage)) {
    return false;
  }
  const std::vector<McapEntry> entries = reader_.entries(reader_.same_as(channel));
  if (entries.empty()) {
    return false;
  }
  return in_context(name_ + ": topic " + in_quotes(channel.topic), [&] {
    const McapMessage message = reader_.read(entries.front());
    if (channel.type == kCompressedImage) {
      return is_compressed_depth(messages::from_bytes<messages::CompressedImage>(message.data));
    }
    const auto image = messages::from_bytes<messages::Image>(message.data);
    return is_depth(image) && image.encoding != "mono16";
  });
}

std::vector<McapImages::Topic> McapImages::depth_topics() {
  std::vector<Topic> found;
  for (const McapChannel& channel : reader_.channels()) {
    // A recorder that began anew makes a channel of a topic that has one.
    const auto is_same = [&](const Topic& topic) {
      return topic.channel->topic == channel.topic && topic.channel->type == channel.type;
    };
    if (std::none_of(found.begin(), found.end(), is_same) && holds_depth(channel)) {
      found.push_back({.channel = &channel,
                       .camera_id = camera_id_of(channel.topic),
                       .compressed = {},
                       .frame_id = {},
                       .images = {}});
    }
  }
  return found;
}

std::vector<McapImages::Topic> McapImages::find_topics(const McapChoice& choice) {
  std::vector<Topic> found;
  for (const std::string& given : choice.depth_topics) {
    Topic topic;
    std::string name;
    topic.camera_id = id_and_topic(given, name);
    topic.channel = reader_.channel(name);
    if (topic.channel == nullptr) {
      fail_choice(name_, ": there is no topic ", in_quotes(name), "; topics: ", list_of_topics());
    }
    check_depth(*topic.channel);
    found.push_back(std::move(topic));
  }
  if (choice.depth_topics.empty()) {
    found = depth_topics();
    const auto is_called_depth = [](const Topic& t) { return t.channel->topic.find("depth") != std::string::npos; };
    if (std::any_of(found.begin(), found.end(), is_called_depth)) {
      std::erase_if(found, [&](const Topic& t) { return !is_called_depth(t); });
    }
    // Of a topic that was recorded both ways the one that nothing was done to.
    std::set<std::string> raw;
    for (const Topic& topic : found) {
      raw.insert(topic.channel->topic);
    }
    std::erase_if(found, [&](const Topic& t) {
      const std::string base(base_topic(t.channel->topic));
      return base != t.channel->topic && raw.contains(base);
    });
    if (found.empty()) {
      fail(name_,
           ": has no depth images: no sensor_msgs/msg/Image of 16UC1 or 32FC1, and no CompressedImage of "
           "compressedDepth; topics: ",
           list_of_topics());
    }
  }
  for (Topic& topic : found) {
    topic.compressed = topic.channel->type == kCompressedImage;
    const auto same = [&](const Topic& other) { return other.camera_id == topic.camera_id; };
    if (std::count_if(found.begin(), found.end(), same) > 1) {
      if (!choice.depth_topics.empty()) {
        fail_choice(name_, ": two topics are of camera ", in_quotes(topic.camera_id), "; name them, ID=TOPIC");
      }
      topic.camera_id = topic.channel->topic.substr(topic.channel->topic.starts_with('/') ? 1 : 0);
    }
  }
  return found;
}

void McapImages::read_stamps(Topic& topic) {
  const std::string where = name_ + ": topic " + in_quotes(topic.channel->topic);
  for (const McapEntry& entry : reader_.entries(reader_.same_as(*topic.channel))) {
    in_context(where + ": message recorded at " + std::to_string(entry.log_time_ns) + " ns", [&] {
      const McapMessage message = reader_.read(entry);
      const messages::Header header = topic.compressed
                                          ? messages::from_bytes<messages::CompressedImage>(message.data).header
                                          : messages::from_bytes<messages::Image>(message.data).header;
      if (topic.images.empty()) {
        topic.frame_id = header.frame_id;
      } else if (topic.frame_id != header.frame_id) {
        fail("frame_id is ", in_quotes(header.frame_id), ", before it was ", in_quotes(topic.frame_id));
      }
      topic.images.push_back({.stamp_ns = messages::nanoseconds(header.stamp), .entry = entry});
    });
  }
  std::sort(topic.images.begin(), topic.images.end(),
            [](const Stamped& a, const Stamped& b) { return a.stamp_ns < b.stamp_ns; });
  const auto same = std::adjacent_find(topic.images.begin(), topic.images.end(),
                                       [](const Stamped& a, const Stamped& b) { return a.stamp_ns == b.stamp_ns; });
  if (same != topic.images.end()) {
    fail(where, ": two images have the time stamp ", same->stamp_ns, " ns in their header; each needs its own");
  }
}

RigCamera McapImages::camera_of(const Topic& topic, const McapChoice& choice) {
  if (choice.intrinsics) {
    RigCamera camera;
    camera.id = topic.camera_id;
    camera.intrinsics = *choice.intrinsics;
    camera.metres_per_unit = messages::kMetresPerUnit;
    return camera;
  }
  const std::string where = name_ + ": topic " + in_quotes(topic.channel->topic);
  const std::string name = !choice.info_topic.empty()
                               ? choice.info_topic
                               : std::string(parent_of(base_topic(topic.channel->topic))) + "/camera_info";
  const McapChannel* channel = reader_.channel(name);
  if (channel == nullptr || channel->type != kCameraInfo) {
    std::string others;
    for (const McapChannel& other : reader_.channels()) {
      if (other.type == kCameraInfo) {
        others += (others.empty() ? "" : ", ") + printable_excerpt(other.topic);
      }
    }
    fail(where, " has no calibration: there is no ", printable_excerpt(name),
         " (camera_info topics: ", others.empty() ? "none" : others, "); give a rig file");
  }
  const std::vector<McapEntry> entries = reader_.entries(reader_.same_as(*channel));
  if (entries.empty()) {
    fail(where, " has no calibration: ", in_quotes(name), " has no messages; give a rig file");
  }
  return in_context(name_ + ": topic " + in_quotes(name), [&] {
    const auto info = messages::from_bytes<messages::CameraInfo>(reader_.read(entries.front()).data);
    for (const McapEntry& entry : entries) {
      if (!same_calibration(messages::from_bytes<messages::CameraInfo>(reader_.read(entry).data), info)) {
        fail("the calibration changes at ", entry.log_time_ns, " ns; give a rig file");
      }
    }
    const messages::CameraModel model = camera_model(info, is_rectified(topic.channel->topic));
    RigCamera camera;
    camera.id = topic.camera_id;
    camera.intrinsics = model.intrinsics;
    camera.distortion = model.distortion;
    camera.metres_per_unit = messages::kMetresPerUnit;
    return camera;
  });
}

void McapImages::place_cameras(const McapChoice& choice) {
  TransformTree tree;
  for (const McapChannel& channel : reader_.channels()) {
    if (channel.type != kTransforms || channel.encoding != "cdr") {
      continue;
    }
    const bool stands = channel.topic.ends_with("tf_static");
    for (const McapEntry& entry : reader_.entries(channel.id)) {
      in_context(name_ + ": topic " + in_quotes(channel.topic), [&] {
        const auto message = messages::from_bytes<messages::Transforms>(reader_.read(entry).data);
        stands ? tree.add_static(message) : tree.add_moving(message);
      });
    }
  }
  std::string world = choice.world_frame;
  const auto is_camera = [&](const Topic& topic) { return topic.frame_id == world; };
  if (!world.empty() && !tree.knows(world) && std::none_of(topics_.begin(), topics_.end(), is_camera)) {
    fail_choice(name_, ": there is no frame ", in_quotes(world), "; frames of /tf_static: ", tree.frames());
  }
  for (std::size_t k = 0; k < topics_.size(); ++k) {
    const Topic& topic = topics_[k];
    in_context(name_ + ": topic " + in_quotes(topic.channel->topic), [&] {
      if (topic.frame_id.empty()) {
        fail("its images have no frame_id, so nothing says where the camera stands; give a rig file");
      }
      if (world.empty()) {
        world = tree.root_of(topic.frame_id);
        if (!tree.knows(topic.frame_id)) {
          fail("no transform says where its frame ", in_quotes(topic.frame_id),
               " stands (frames of /tf_static: ", tree.frames(), "); give a rig file, or --world ", topic.frame_id,
               " if it is the only camera");
        }
      }
      rig_file_.rig.cameras[k].T_world_camera = tree.T(world, topic.frame_id);
    });
  }
  notes_.push_back(name_ + ": the world is frame " + in_quotes(world));
}

std::vector<std::vector<double>> McapImages::times_s() const {
  std::vector<std::vector<double>> all;
  for (const Topic& topic : topics_) {
    std::vector<double>& times = all.emplace_back();
    for (const Stamped& image : topic.images) {
      const auto sec = image.stamp_ns / 1'000'000'000;
      times.push_back(static_cast<double>(sec) + static_cast<double>(image.stamp_ns % 1'000'000'000) * 1e-9);
    }
  }
  return all;
}

DepthView McapImages::read(std::size_t camera, std::size_t image, const RigCamera& of, const PinholeCamera& recorded,
                           McapPixels& pixels) {
  const Topic& topic = topics_[camera];
  const Stamped& stamped = topic.images[image];
  const std::string where =
      name_ + ": topic " + in_quotes(topic.channel->topic) + ", image of " + std::to_string(stamped.stamp_ns) + " ns";
  if (topic.compressed) {
    const auto message = in_context(
        where, [&] { return messages::from_bytes<messages::CompressedImage>(reader_.read(stamped.entry).data); });
    const auto depth = in_context(where, [&] { return compressed_depth(message); });
    read_png16(depth.png, where, recorded, of.id, pixels.png);
    return depth_view(pixels.png.pixels, pixels.png.width_px, pixels.png.height_px, of.metres_per_unit);
  }
  return in_context(where, [&] {
    const auto message = messages::from_bytes<messages::Image>(reader_.read(stamped.entry).data);
    const DepthView view = depth_view(message, pixels.raw, of.metres_per_unit);
    if (view.width_px != recorded.width_px || view.height_px != recorded.height_px) {
      fail("is ", view.width_px, " x ", view.height_px, " pixels, the calibration of camera '", of.id, "' is for ",
           recorded.width_px, " x ", recorded.height_px);
    }
    return copied(view, pixels.raw);
  });
}

}  // namespace depthgrid::files
