#include "depthgrid/files/frame_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/depth_file_pattern.hpp"
#include "depthgrid/files/image_list.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::files {
namespace {

namespace fs = std::filesystem;

/// The place in ascending times that is nearest to `time_s`.
std::size_t nearest(const std::vector<double>& times_s, double time_s) {
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) {
    return 0;
  }
  if (after == times_s.end()) {
    return times_s.size() - 1;
  }
  const auto index = static_cast<std::size_t>(after - times_s.begin());
  return *after - time_s < time_s - *(after - 1) ? index : index - 1;
}

std::string join(const fs::path& folder, const std::string& file) { return (folder / file).string(); }

}  // namespace

FrameTable::Images FrameTable::images_of(const RigFile& rig_file, std::size_t camera, const fs::path& folder,
                                         const std::string& name) {
  Images images;
  const std::string& pattern = rig_file.depth_files[camera];
  if (camera < rig_file.tracks.size() && !rig_file.tracks[camera].depth_list.empty()) {
    const fs::path list = rig_file.tracks[camera].depth_list;
    const fs::path list_file = folder / list;
    for (StampedImage& image : parse_image_list(read_text_file(list_file), list_file.string())) {
      images.time_s.push_back(image.time_s);
      images.file.push_back(join(list.parent_path(), image.file));
    }
    return images;
  }
  if (pattern.empty()) {
    fail(name, ": camera '", rig_file.rig.cameras[camera].id,
         "' has no depth_files and no depth_list, so there are no images to read");
  }
  const bool is_folder = names_folder(pattern);
  if (!is_folder && checked_conversion(pattern) != kTimeConversion) {
    images.pattern = pattern;
    return images;
  }
  const fs::path place = is_folder ? fs::path(pattern) : fs::path(pattern).parent_path();
  const std::string form = is_folder ? std::string(kTimeConversion) + ".png" : fs::path(pattern).filename().string();
  const std::size_t at = form.find(kTimeConversion);
  if (at == std::string::npos) {
    fail(name, ": camera '", rig_file.rig.cameras[camera].id, "': '", pattern, "' has ", kTimeConversion,
         " in the name of a folder, must have it in the file's name");
  }
  const fs::path where = folder / place;  // empty: both are the folder that the program runs in
  FolderImages found = images_of_folder(where.empty() ? fs::path(".") : where, form.substr(0, at),
                                        form.substr(at + kTimeConversion.size()), !is_folder);
  images.time_s = std::move(found.time_s);
  images.number = std::move(found.number);
  for (const std::string& file : found.file) {
    images.file.push_back(join(place, file));
  }
  return images;
}

FrameTable::FrameTable(const RigFile& rig_file, const fs::path& folder, const std::string& name)
    : first_(rig_file.first_frame),
      count_(rig_file.frame_count),
      simultaneous_(rig_file.simultaneous),
      rate_hz_(rig_file.rate_hz) {
  for (std::size_t k = 0; k < rig_file.rig.cameras.size(); ++k) {
    images_.push_back(images_of(rig_file, k, folder, name));
  }
  by_time_ = std::any_of(images_.begin(), images_.end(), [](const Images& images) { return !images.time_s.empty(); });
  if (by_time_) {
    match_times(rig_file, name);
  } else {
    match_numbers(rig_file, name);
  }
}

FrameTable::FrameTable(const RigFile& rig_file, const std::vector<std::vector<double>>& times_s,
                       const std::string& name)
    : first_(rig_file.first_frame), by_time_(true) {
  for (const std::vector<double>& times : times_s) {
    images_.push_back({.pattern = {}, .file = {}, .time_s = times, .number = {}});
  }
  match_times(rig_file, name);
}

void FrameTable::match_times(const RigFile& rig_file, const std::string& name) {
  for (std::size_t k = 0; k < images_.size(); ++k) {
    if (images_[k].time_s.empty()) {
      fail(name, ": camera '", rig_file.rig.cameras[k].id,
           "' has images without time stamps beside cameras that have some; give it a depth_list");
    }
  }
  const int available = static_cast<int>(images_.front().time_s.size());
  if (rig_file.count_stated && rig_file.frame_count > available) {
    fail(name, ": /frames/count is ", rig_file.frame_count, ", but camera '", rig_file.rig.cameras.front().id, "' has ",
         available, " images; it may be left out");
  }
  count_ = rig_file.count_stated ? rig_file.frame_count : available;
  if (images_.size() > 1 && !rig_file.tolerance_s) {
    fail(name,
         ": /frames/tolerance_s is missing: images of several cameras are put together by their times, and it says "
         "how far apart, in seconds, images of one frame may be");
  }
  chosen_.resize(images_.size());
  for (std::size_t k = 0; k < images_.size(); ++k) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
      const double time_s = images_.front().time_s[i];
      const std::size_t near = k == 0 ? i : nearest(images_[k].time_s, time_s);
      const double apart_s = std::abs(images_[k].time_s[near] - time_s);
      const bool within = k == 0 || apart_s <= *rig_file.tolerance_s;
      chosen_[k].push_back(within ? near : kNoImage);
      simultaneous_ = simultaneous_ && (!within || apart_s <= kSameInstant_s);
    }
  }
}

void FrameTable::match_numbers(const RigFile& rig_file, const std::string& name) {
  const auto listed =
      std::find_if(images_.begin(), images_.end(), [](const Images& images) { return !images.number.empty(); });
  if (listed == images_.end()) {
    return;
  }
  for (const int number : listed->number) {
    if (number >= first_ && (!rig_file.count_stated || number - first_ < rig_file.frame_count)) {
      numbers_.push_back(number);
    }
  }
  if (numbers_.empty()) {
    fail(name, ": no image of camera '", rig_file.rig.cameras[static_cast<std::size_t>(listed - images_.begin())].id,
         "' has a number that /frames/first and /frames/count allow; its images are numbered ", listed->number.front(),
         " to ", listed->number.back());
  }
  count_ = static_cast<int>(numbers_.size());
}

int FrameTable::number(int index) const noexcept {
  return numbers_.empty() ? first_ + index : numbers_[static_cast<std::size_t>(index)];
}

std::optional<std::size_t> FrameTable::image(int index, std::size_t camera) const {
  const std::size_t chosen = chosen_[camera][static_cast<std::size_t>(index)];
  return chosen == kNoImage ? std::nullopt : std::optional(chosen);
}

std::optional<std::string> FrameTable::file(int index, std::size_t camera) const {
  const Images& images = images_[camera];
  if (by_time_) {
    const std::size_t chosen = chosen_[camera][static_cast<std::size_t>(index)];
    return chosen == kNoImage ? std::nullopt : std::optional(images.file[chosen]);
  }
  if (!images.pattern.empty()) {
    return depth_file_name(images.pattern, number(index));
  }
  const auto found = std::lower_bound(images.number.begin(), images.number.end(), number(index));
  if (found == images.number.end() || *found != number(index)) {
    return std::nullopt;
  }
  return images.file[static_cast<std::size_t>(found - images.number.begin())];
}

std::optional<double> FrameTable::time_s(int index, std::size_t camera) const {
  if (by_time_) {
    const std::size_t chosen = chosen_[camera][static_cast<std::size_t>(index)];
    return chosen == kNoImage ? images_.front().time_s[static_cast<std::size_t>(index)]
                              : images_[camera].time_s[chosen];
  }
  return rate_hz_ ? std::optional((number(index) - number(0)) / *rate_hz_) : std::nullopt;
}

}  // namespace depthgrid::files
