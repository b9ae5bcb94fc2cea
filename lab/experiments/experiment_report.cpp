#include "lab/experiments/experiment_report.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/text_file.hpp"
#include "report/machine.hpp"

namespace depthgrid::experiments {

namespace fs = std::filesystem;

namespace {

/// Throws Error unless files can be created in it once it is there.
void check_folder(const fs::path& folder) {
  std::error_code error;
  if (folder.empty()) {
    fail("the report needs a folder: give --out DIR");
  }
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    fail("cannot write the report to ", folder.string(), ": it is a file; name a folder");
  }
  fs::path place = folder;
  if (!fs::is_directory(folder, error)) {
    place = fs::absolute(folder).lexically_normal();
    place = (place.has_filename() ? place : place.parent_path()).parent_path();
    if (fs::exists(place, error) && !fs::is_directory(place, error)) {
      fail("cannot write the report to ", folder.string(), ": ", place.string(), " is a file");
    }
    if (!fs::is_directory(place, error)) {
      fail("cannot write the report to ", folder.string(), ": there is no folder ", place.string(),
           "; create it first");
    }
  }
  if (::access(place.c_str(), W_OK | X_OK) != 0) {
    fail("cannot write the report to ", folder.string(), ": ", std::generic_category().message(errno));
  }
  for (const char* name : {"report.md", "figures.json"}) {
    if (fs::is_directory(folder / name, error)) {
      fail("cannot write the report to ", folder.string(), ": ", (folder / name).string(), " is a folder");
    }
  }
}

std::string frame_name(std::size_t frame) {
  const std::string number = std::to_string(frame + 1);
  return "frame-" + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number + ".png";
}

}  // namespace

ExperimentReport::ExperimentReport(const Experiment& experiment, const Options& options) : folder_(options.out) {
  check_folder(folder_);
  about_["experiment"] = experiment.name;
  about_["program"] = "depthgrid " DEPTHGRID_VERSION;
  about_["command"] = options.command_line;
  about_["seed"] = options.seed;
  about_["quick"] = options.quick;
  about_["started"] = report::now_utc();
  about_["machine"] = report::machine_line(experiment.cores_used);
  markdown_ = "# " + std::string(experiment.name) + "\n";
  if (!options.command_line.empty()) {
    paragraph("`" + options.command_line + "`, " + report::now_utc() + (options.quick ? ", a quick run." : "."));
  }
  paragraph("Machine: " + report::machine_line(experiment.cores_used) + ".");
}

void ExperimentReport::paragraph(std::string_view markdown) { markdown_.append("\n").append(markdown).append("\n"); }

void ExperimentReport::headline(std::string_view sentence) {
  headlines_.emplace_back(sentence);
  paragraph(sentence);
}

void ExperimentReport::picture(std::string file, report::Canvas canvas, std::string_view caption) {
  paragraph("![" + file + "](" + file + ")");
  paragraph("*" + std::string(caption) + "*");
  pictures_.emplace_back(std::move(file), std::move(canvas));
}

void ExperimentReport::frame(report::Canvas canvas) { frames_.push_back(std::move(canvas)); }

void ExperimentReport::write() const {
  std::error_code error;
  if (!fs::is_directory(folder_, error) && !fs::create_directory(folder_, error)) {
    fail("cannot create the folder ", folder_.string(), ": ", error.message());
  }
  for (const auto& [file, canvas] : pictures_) {
    canvas.save_png(folder_ / file);
  }
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    frames_[i].save_png(folder_ / frame_name(i));
  }
  nlohmann::ordered_json all;
  all["about"] = about_;
  all["figures"] = figures_;
  files::write_text_file(folder_ / "figures.json", all.dump(2) + "\n");
  files::write_text_file(folder_ / "report.md", markdown_);
}

std::string ExperimentReport::text() const {
  std::string text;
  for (const std::string& sentence : headlines_) {
    text += sentence + "\n";
  }
  text += "Report: " + (folder_ / "report.md").string() + ", figures.json";
  for (const auto& [file, canvas] : pictures_) {
    text += ", " + file;
  }
  if (!frames_.empty()) {
    text += ", " + frame_name(0) + " to " + frame_name(frames_.size() - 1);
  }
  return text + "\n";
}

}  // namespace depthgrid::experiments
