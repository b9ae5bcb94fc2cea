// A map of a cell file: known keys, each read once with its rule, and where it stood. Internal.
#pragma once

#include <yaml-cpp/yaml.h>  // all of it: node/node.h alone leaves YAML::Node's inline functions undefined

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::cell {

/// A range that a number has to be in; `above`: the least itself is not in it.
struct Range {
  double least = 0;
  double most = 0;
  bool above = false;
};

/// - Errors: every function throws Error: "FILE:LINE:COLUMN: PATH: value, rule, hint", one line.
class Section {
 public:
  /// The whole document. The lists outlive it. Throws Error where the text is no YAML, or too large, and as below.
  Section(std::string_view text, const std::string& file, std::vector<ShownValue>& shown,
          std::span<const std::string_view> known);

  [[nodiscard]] bool has(std::string_view key) const { return find(key).has_value(); }
  /// The map under a key, which must be there; its keys are among the known ones.
  [[nodiscard]] Section map(std::string_view key, std::span<const std::string_view> known, std::string_view hint) const;
  /// The same, or one without keys where there is none: everything in it is a default.
  [[nodiscard]] Section map_or_empty(std::string_view key, std::span<const std::string_view> known) const;
  /// The maps of a list, at least one.
  [[nodiscard]] std::vector<Section> maps(std::string_view key, std::span<const std::string_view> known,
                                          std::string_view hint) const;
  [[nodiscard]] bool is_map(std::string_view key) const;
  [[nodiscard]] bool is_list(std::string_view key) const;

  /// One line of text, not empty. Without a default the key must be there.
  [[nodiscard]] std::string text(std::string_view key, std::string_view hint,
                                 std::optional<std::string_view> otherwise = {}) const;
  /// One of these words.
  [[nodiscard]] std::string word(std::string_view key, std::span<const std::string_view> words, std::string_view hint,
                                 std::optional<std::string_view> otherwise = {}) const;
  [[nodiscard]] bool yes(std::string_view key, bool otherwise) const;
  [[nodiscard]] double number(std::string_view key, const Range& range, std::string_view unit, std::string_view hint,
                              std::optional<double> otherwise = {}) const;
  /// Nothing where the key is not there.
  [[nodiscard]] std::optional<double> number_if(std::string_view key, const Range& range, std::string_view unit) const;
  [[nodiscard]] int whole(std::string_view key, int least, int most, std::string_view unit,
                          std::string_view hint) const;
  /// A list of `count` finite numbers.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count, double most, std::string_view unit,
                                            std::string_view hint) const;
  [[nodiscard]] Eigen::Vector3d vector(std::string_view key, std::string_view hint) const;
  [[nodiscard]] std::vector<std::string> texts(std::string_view key, std::string_view hint) const;

  /// "FILE:LINE:COLUMN: PATH" of the key, or of the map where it is not there.
  [[nodiscard]] std::string place(std::string_view key = {}) const;
  template <class... Parts>
  [[noreturn]] void refuse(std::string_view key, const Parts&... parts) const {
    fail(place(key), ": ", parts...);
  }
  void show(std::string_view key, const std::string& value, std::string_view unit, const std::string& origin) const;

 private:
  struct Entry {
    std::string key;
    YAML::Mark mark;
    YAML::Node value;
  };
  Section(const YAML::Node& node, std::string path, std::string file, std::vector<ShownValue>& shown,
          std::span<const std::string_view> known);
  [[nodiscard]] std::optional<Entry> find(std::string_view key) const;
  [[nodiscard]] Entry need(std::string_view key, std::string_view hint) const;
  [[nodiscard]] std::string path(std::string_view key) const;

  std::string file_;
  std::string path_;
  YAML::Mark mark_;
  std::vector<Entry> entries_;
  std::vector<ShownValue>* shown_;
};

}  // namespace depthgrid::cell
