// The depth images of an MCAP file, and the cameras that they are of. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/files/recording.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/messages/image.hpp"

namespace depthgrid::files {

/// Memory of one camera's image, used again for the next.
struct McapPixels {
  messages::DepthPixels raw;
  Gray16Image png;
};

/// Not thread-safe.
class McapImages {
 public:
  /// Looks for the topics, the calibrations and the places of cameras as McapChoice says, and reads the time stamp of
  /// every image. Throws Error, and ChoiceError for what the file does not have.
  McapImages(const std::filesystem::path& file, const McapChoice& choice, const std::vector<std::string>& camera_ids);

  /// Of the cameras chosen, in their order: of the rig file, or made of the messages.
  [[nodiscard]] const RigFile& rig_file() const noexcept { return rig_file_; }
  /// Stamps in seconds, ascending, for each camera.
  [[nodiscard]] std::vector<std::vector<double>> times_s() const;
  /// What was found, a line each, and what is missing of the file.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// The image of that index in the order of time, `width_px` x `height_px`; a view of `pixels` or of memory that lasts
  /// until the next read. Throws Error that names topic and time.
  [[nodiscard]] DepthView read(std::size_t camera, std::size_t image, const RigCamera& of,
                               const PinholeCamera& recorded, McapPixels& pixels);

 private:
  struct Stamped {
    std::int64_t stamp_ns = 0;
    McapEntry entry;
  };
  struct Topic {
    const McapChannel* channel = nullptr;
    std::string camera_id;
    bool compressed = false;
    std::string frame_id;
    std::vector<Stamped> images;
  };

  [[nodiscard]] std::vector<Topic> find_topics(const McapChoice& choice);
  [[nodiscard]] std::vector<Topic> depth_topics();
  [[nodiscard]] bool holds_depth(const McapChannel& channel);
  void check_depth(const McapChannel& channel);
  [[nodiscard]] std::string list_of_topics();
  void read_stamps(Topic& topic);
  [[nodiscard]] RigCamera camera_of(const Topic& topic, const McapChoice& choice);
  void place_cameras(const McapChoice& choice);

  std::string name_;
  McapReader reader_;
  RigFile rig_file_;
  std::vector<Topic> topics_;  ///< one a camera
  std::vector<std::string> notes_;
};

}  // namespace depthgrid::files
