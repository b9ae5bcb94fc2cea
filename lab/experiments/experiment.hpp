// What every experiment takes, and the list of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace depthgrid::experiments {

class ExperimentReport;

/// Called while an experiment runs: `done` of `total` steps of about the same length are behind it.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

struct Options {
  std::filesystem::path out;      ///< folder of the report; created if its parent exists
  bool quick = false;             ///< smaller images and fewer frames: figures that show the effect, no more
  std::uint64_t seed = 1;         ///< of everything random: person, sensors
  std::optional<int> frames{};    ///< instants of time; none: the experiment's own number
  std::optional<int> width_px{};  ///< of the depth images, which are 4:3; none: the experiment's own
  /// A sensor model of all cameras; none: the experiment's own. With it the search with what is declared for the sensor
  /// and with a memory is measured, too.
  std::optional<std::string> sensor{};
  std::string command_line{};  ///< as the user typed it, for the report
  Progress progress = [](std::size_t, std::size_t) {};
};

/// Throws Error with value and rule: frames in 1 ... 100000, width in 32 ... 1280 and a multiple of 4, a sensor that
/// there is.
void validate(const Options& options);

/// `frames` and `width_px` as given, else the experiment's own numbers.
[[nodiscard]] int frames_or(const Options& options, int full, int quick);
[[nodiscard]] int width_or(const Options& options, int full, int quick);
/// The model's own name, which lives as long as the program. Throws Error when there is no such sensor.
[[nodiscard]] std::string_view sensor_or(const Options& options, std::string_view own);

struct Experiment {
  std::string_view name;     ///< as on the command line
  std::string_view summary;  ///< one line
  /// Fills the report, which the caller writes. Throws Error.
  void (*run)(const Options& options, ExperimentReport& report);
  std::string_view cores_used = "one";  ///< for the report
};

/// In the order of --list.
[[nodiscard]] std::span<const Experiment> experiments() noexcept;

/// Throws Error that lists the names there are.
[[nodiscard]] const Experiment& experiment(std::string_view name);

/// Runs it and writes the report into options.out. Looks at the folder first, so that a wrong one costs no time.
/// Returns the report's short text. Throws Error; then nothing was written, or the disk failed while the report was.
std::string run_experiment(const Experiment& experiment, const Options& options);

}  // namespace depthgrid::experiments
