// The folder that an experiment leaves: report.md, figures.json and pictures.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/experiments/experiment.hpp"
#include "report/canvas.hpp"

namespace depthgrid::experiments {

/// Everything is kept in memory until write(), so an experiment that fails leaves nothing behind. figures.json begins
/// with what was run, when, and on which machine.
class ExperimentReport {
 public:
  /// Throws Error when options.out is a file, cannot be written, or has no parent folder. Creates nothing.
  ExperimentReport(const Experiment& experiment, const Options& options);

  /// The measured figures: an object with one entry a subject, units in the names.
  [[nodiscard]] nlohmann::ordered_json& figures() noexcept { return figures_; }

  /// Markdown for report.md: appended as paragraphs of their own.
  void paragraph(std::string_view markdown);

  /// Also a line of the short text that the command prints.
  void headline(std::string_view sentence);

  /// `file` without folder, ends in .png; appears in report.md at this place with `caption` below it.
  void picture(std::string file, report::Canvas canvas, std::string_view caption);

  /// The next frame of a film: frame-0001.png and so on, which the report names together.
  void frame(report::Canvas canvas);

  /// Writes pictures, frames, figures.json and, last, report.md, each complete or not at all. Throws Error.
  void write() const;

  /// The headlines, and the files that write() writes.
  [[nodiscard]] std::string text() const;

 private:
  std::filesystem::path folder_;
  nlohmann::ordered_json about_;
  nlohmann::ordered_json figures_ = nlohmann::ordered_json::object();
  std::string markdown_;
  std::vector<std::string> headlines_;
  std::vector<std::pair<std::string, report::Canvas>> pictures_;
  std::vector<report::Canvas> frames_;
};

}  // namespace depthgrid::experiments
