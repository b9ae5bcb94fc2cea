#include "depthgrid/files/image_kind.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace depthgrid::files {
namespace {

struct Kind {
  std::string_view name;
  std::array<std::string_view, 2> begins;   ///< either; empty: none
  std::array<std::string_view, 3> endings;  ///< lower case
};

using namespace std::string_view_literals;

constexpr std::array<Kind, 7> kKinds{{{"JPEG", {"\xFF\xD8\xFF"sv, {}}, {".jpg", ".jpeg", {}}},
                                      {"TIFF", {"II*\0"sv, "MM\0*"sv}, {".tif", ".tiff", {}}},
                                      {"OpenEXR", {"\x76\x2F\x31\x01"sv, {}}, {".exr", {}, {}}},
                                      {"PGM", {"P5"sv, "P2"sv}, {".pgm", ".pnm", {}}},
                                      {"PFM", {"Pf"sv, "PF"sv}, {".pfm", {}, {}}},
                                      {"NumPy", {"\x93NUMPY"sv, {}}, {".npy", ".npz", {}}},
                                      {"BMP", {"BM"sv, {}}, {".bmp", {}, {}}}}};

bool ends_with_ignoring_case(std::string_view text, std::string_view lower) noexcept {
  return text.size() >= lower.size() &&
         std::equal(lower.begin(), lower.end(), text.end() - static_cast<std::ptrdiff_t>(lower.size()),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

}  // namespace

std::string_view image_kind_of_bytes(std::string_view first_bytes) noexcept {
  for (const Kind& kind : kKinds) {
    for (const std::string_view begin : kind.begins) {
      if (!begin.empty() && first_bytes.starts_with(begin)) {
        return kind.name;
      }
    }
  }
  return {};
}

std::string_view image_kind_of_name(std::string_view name) noexcept {
  for (const Kind& kind : kKinds) {
    for (const std::string_view ending : kind.endings) {
      if (!ending.empty() && ends_with_ignoring_case(name, ending)) {
        return kind.name;
      }
    }
  }
  return {};
}

std::string way_to_png(std::string_view kind) {
  const bool lossy = kind == "JPEG";
  return "depth images need to be 16-bit gray PNG: " +
         (lossy ? std::string("JPEG has lost the depths, record them anew")
                : "write the " + std::string(kind) +
                      " files' depths in units of metres_per_unit (millimetres: 0.001) as such, with OpenCV's imwrite, "
                      "say");
}

}  // namespace depthgrid::files
