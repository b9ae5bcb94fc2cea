#include "depthgrid/files/image_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/depth_file_pattern.hpp"
#include "depthgrid/files/image_kind.hpp"
#include "depthgrid/files/text_lines.hpp"

namespace depthgrid::files {
namespace {

namespace fs = std::filesystem;

constexpr double kLatestTime_s = 1e11;

std::string checked_path(const LinePlace& place, std::string_view word) {
  std::string path(word);
  try {
    check_stays_inside(path);
  } catch (const Error& error) {
    fail_at_line(place, error.what());
  }
  return path;
}

bool is_of_depth(std::string_view file) noexcept { return file.find("depth") != std::string_view::npos; }

/// The word before the depth image's name.
std::size_t depth_pair(const LinePlace& place, const std::vector<std::string_view>& words) {
  if (words.size() == 2) {
    return 0;
  }
  if (words.size() != 4) {
    fail_at_line(place, words.size(), " words, must be 2 (time_s file) or 4 (time_s file time_s file)");
  }
  if (is_of_depth(words[1]) == is_of_depth(words[3])) {
    fail_at_line(place, "one of '", printable_excerpt(words[1]), "' and '", printable_excerpt(words[3]),
                 "' must have \"depth\" in its path, to tell which is the depth image");
  }
  return is_of_depth(words[1]) ? 0 : 2;
}

/// What stands between prefix and suffix; nothing where the name has another form.
std::optional<std::string_view> middle_of(std::string_view name, std::string_view prefix, std::string_view suffix) {
  if (name.size() < prefix.size() + suffix.size() || name.substr(0, prefix.size()) != prefix ||
      name.substr(name.size() - suffix.size()) != suffix || name.front() == '.') {
    return std::nullopt;
  }
  return name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
}

bool is_all_digits(std::string_view text) noexcept {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Digits, a point and digits.
bool is_decimal(std::string_view text) noexcept {
  const std::size_t point = text.find('.');
  return point != std::string_view::npos && is_all_digits(text.substr(0, point)) &&
         is_all_digits(text.substr(point + 1));
}

struct NamedImage {
  double value = 0;  ///< time or number
  std::string file;
};

/// All names of the right form, with their middles still to be read.
std::vector<std::pair<std::string, std::string>> middles_of(const fs::path& folder, const std::string& prefix,
                                                            const std::string& suffix) {
  std::vector<std::pair<std::string, std::string>> found;
  std::string other;  // an image that cannot be read here, the first by name
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (!image_kind_of_name(name).empty() && (other.empty() || name < other)) {
      other = name;
    }
    if (const auto middle = middle_of(name, prefix, suffix)) {
      found.emplace_back(std::string(*middle), std::move(name));
    }
  }
  if (error) {
    fail(folder.string(), ": cannot be read: ", error.message());
  }
  if (found.empty()) {
    if (!other.empty()) {
      const std::string_view kind = image_kind_of_name(other);
      fail(folder.string(), ": has no file '", prefix, "...", suffix, "' but ", kind, " ('", printable_excerpt(other),
           "'), ", way_to_png(kind));
    }
    fail(folder.string(), ": has no file '", prefix, "...", suffix, "', so there are no images to read");
  }
  return found;
}

/// The time or number that a middle says; nothing where it says none.
std::optional<double> value_of(const std::string& middle, bool is_time) {
  if (is_time) {
    const auto time_s = is_decimal(middle) || is_all_digits(middle) ? parse_number<double>(middle) : std::nullopt;
    return time_s && *time_s <= kLatestTime_s ? time_s : std::nullopt;
  }
  const auto number = is_all_digits(middle) ? parse_number<int>(middle) : std::nullopt;
  return number ? std::optional<double>(*number) : std::nullopt;
}

void sort_distinct(const fs::path& folder, bool by_time, std::vector<NamedImage>& images) {
  std::sort(images.begin(), images.end(), [](const NamedImage& a, const NamedImage& b) { return a.value < b.value; });
  const double least = by_time ? kSameInstant_s : 0.0;
  for (std::size_t k = 1; k < images.size(); ++k) {
    if (!(images[k].value > images[k - 1].value + least)) {
      fail(folder.string(), ": '", images[k - 1].file, "' and '", images[k].file, "' are of the same ",
           by_time ? "time" : "number");
    }
  }
}

}  // namespace

double time_of(const LinePlace& place, std::string_view word) {
  const auto time_s = parse_number<double>(word);
  if (!time_s || !std::isfinite(*time_s)) {
    fail_at_line(place, "time is '", printable_excerpt(word), "', must be a number of seconds");
  }
  if (std::abs(*time_s) > kLatestTime_s) {
    fail_at_line(place, "time is '", printable_excerpt(word),
                 "', must be at most 1e11 seconds; milliseconds, microseconds or nanoseconds have to be divided first");
  }
  return *time_s;
}

std::vector<StampedImage> parse_image_list(std::string_view text, const std::string& name) {
  std::vector<StampedImage> images;
  for_each_line(text, name, [&](const LinePlace& place, const std::vector<std::string_view>& words) {
    const std::size_t pair = depth_pair(place, words);
    const double time_s = time_of(place, words[pair]);
    if (!images.empty() && !(time_s > images.back().time_s + kSameInstant_s)) {
      fail_at_line(place, "time '", printable_excerpt(words[pair]),
                   "' is not after that of the image before, must ascend");
    }
    images.push_back({time_s, checked_path(place, words[pair + 1])});
  });
  if (images.empty()) {
    fail(name, ": names no image, needs lines of: time_s file");
  }
  return images;
}

FolderImages images_of_folder(const fs::path& folder, const std::string& prefix, const std::string& suffix,
                              bool times) {
  const auto middles = middles_of(folder, prefix, suffix);
  FolderImages images;
  images.by_time = times || is_decimal(middles.front().first);
  std::vector<NamedImage> found;
  for (const auto& [middle, file] : middles) {
    const bool fits = is_decimal(middle) == images.by_time || times;
    const auto value = fits ? value_of(middle, images.by_time) : std::nullopt;
    if (!value) {
      fail((folder / file).string(), ": the name is no ",
           images.by_time ? "time in seconds up to 1e11 (1305031102.160407)" : "frame's number up to 2147483647",
           fits ? "" : ", as those of others here are",
           R"(; write the names as a pattern ("frame-%06d.png") or in a list ("depth_list"))");
    }
    found.push_back({*value, file});
  }
  sort_distinct(folder, images.by_time, found);
  for (NamedImage& image : found) {
    if (images.by_time) {
      images.time_s.push_back(image.value);
    } else {
      images.number.push_back(static_cast<int>(image.value));
    }
    images.file.push_back(std::move(image.file));
  }
  return images;
}

}  // namespace depthgrid::files
