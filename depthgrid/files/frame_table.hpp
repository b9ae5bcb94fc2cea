// Which images make a frame: by their numbers, or put together by their times. Internal.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/files/rig_file.hpp"

namespace depthgrid::files {

/// The frames of a recording.
///
/// By number: frame n is the image n of every camera. By time, where the images have time stamps: every image of the
/// first camera is a frame, and of every other camera the image nearest in time, if it is within tolerance_s; else that
/// camera has no image there. Immutable.
class FrameTable {
 public:
  /// Reads lists and folders of the rig file's cameras. `name` is the rig file in messages. Throws Error.
  FrameTable(const RigFile& rig_file, const std::filesystem::path& folder, const std::string& name);

  /// Of images that lie elsewhere and have these times, ascending, a list a camera. Throws Error.
  FrameTable(const RigFile& rig_file, const std::vector<std::vector<double>>& times_s, const std::string& name);

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] int number(int index) const noexcept;
  [[nodiscard]] bool by_time() const noexcept { return by_time_; }
  /// Whether all images of every frame were taken at one instant.
  [[nodiscard]] bool simultaneous() const noexcept { return simultaneous_; }
  /// Relative to the rig file's folder. None: the camera has no image in this frame.
  [[nodiscard]] std::optional<std::string> file(int index, std::size_t camera) const;
  /// By time: which of the camera's images it is. None: the camera has no image in this frame.
  [[nodiscard]] std::optional<std::size_t> image(int index, std::size_t camera) const;
  /// Time of the camera's image; the frame's where it has none. None: the recording does not say.
  [[nodiscard]] std::optional<double> time_s(int index, std::size_t camera) const;

 private:
  /// What a camera's images are called. One of the first two is empty.
  struct Images {
    std::string pattern;
    std::vector<std::string> file;
    std::vector<double> time_s;  ///< where they have times
    std::vector<int> number;     ///< where they have numbers
  };
  static constexpr std::size_t kNoImage = static_cast<std::size_t>(-1);

  static Images images_of(const RigFile& rig_file, std::size_t camera, const std::filesystem::path& folder,
                          const std::string& name);
  void match_times(const RigFile& rig_file, const std::string& name);
  void match_numbers(const RigFile& rig_file, const std::string& name);

  std::vector<Images> images_;                    ///< one a camera
  std::vector<std::vector<std::size_t>> chosen_;  ///< by_time: [camera][frame], an index into its images or kNoImage
  std::vector<int> numbers_;                      ///< of the frames; empty: first_ and counting
  int first_ = 0;
  int count_ = 0;
  bool by_time_ = false;
  bool simultaneous_ = true;
  std::optional<double> rate_hz_;
};

}  // namespace depthgrid::files
