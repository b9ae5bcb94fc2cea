// Which image was taken when: lists of files, and folders whose file names say it. Internal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::files {

/// Stamps that differ by no more are of one instant: their last digit at six decimals.
inline constexpr double kSameInstant_s = 1e-6;

struct StampedImage {
  double time_s = 0;
  std::string file;  ///< relative to the folder of the list
};

/// Lines of "time_s file", as in TUM's depth.txt, or two such pairs a line, as in its associations: then the pair whose
/// file's path holds "depth". Lines that begin with # are comments. Throws Error that names file, line, value and rule:
/// no number, times that do not ascend, paths that leave the folder, a wrong number of words, no image at all.
std::vector<StampedImage> parse_image_list(std::string_view text, const std::string& name);

/// The images of a folder, in the order of their times or numbers.
struct FolderImages {
  bool by_time = false;
  std::vector<double> time_s;  ///< where by_time
  std::vector<int> number;     ///< else
  std::vector<std::string> file;
};

/// All files of `folder` whose names begin with `prefix` and end with `suffix`; between them stands a number. With a
/// fraction (1305031102.160407) it is a time in seconds, without one (0000000005) a frame's number, and all are of one
/// kind; with `times` all are times. Names that begin with a dot are passed over. Throws Error that names what is
/// neither, two of one time or number, and a folder without such files.
FolderImages images_of_folder(const std::filesystem::path& folder, const std::string& prefix, const std::string& suffix,
                              bool times);

}  // namespace depthgrid::files
