#include "program/cell/cell_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/usable_frame.hpp"
#include "depthgrid/monitor/device_says.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/found_cameras.hpp"
#include "program/usage_error.hpp"
#include "report/number_text.hpp"

namespace depthgrid::program {
namespace {

/// How long a source is waited for.
constexpr double kPatience_s = 3;

void say(const std::string& line) { (void)std::fputs((printable(line) + "\n").c_str(), stdout); }

/// Columns as wide as their longest text.
void show_table(const std::vector<cell::ShownValue>& values) {
  std::size_t key = 0;
  std::size_t value = 0;
  for (const cell::ShownValue& shown : values) {
    key = std::max(key, shown.key.size());
    value = std::max(value, shown.value.size() + shown.unit.size() + 1);
  }
  for (const cell::ShownValue& shown : values) {
    std::string line = shown.key + std::string(key + 2 - shown.key.size(), ' ');
    const std::string text = shown.value + (shown.unit.empty() ? "" : " " + shown.unit);
    line += text + std::string(value + 2 - std::min(text.size(), value), ' ') + shown.origin;
    say(line);
  }
}

void show(const std::string& file) {
  const cell::Cell cell = cell::load_cell(file);
  std::vector<cell::ShownValue> values = cell.shown;
  const cell::CellSetup setup = cell::setup(cell);
  values.insert(values.end(), setup.shown.begin(), setup.shown.end());
  show_table(values);
}

/// What the device says of itself, as the file states it.
void show_device(const sensors::SourceInfo& info) {
  if (info.intrinsics) {
    const Eigen::Vector2d centre = principal_point_opencv(*info.intrinsics);
    say("    intrinsics: {width_px: " + std::to_string(info.intrinsics->width_px) + ", height_px: " +
        std::to_string(info.intrinsics->height_px) + ", fx_px: " + report::fixed(info.intrinsics->fx_px, 3) +
        ", fy_px: " + report::fixed(info.intrinsics->fy_px, 3) + ", cx_px: " + report::fixed(centre.x(), 3) +
        ", cy_px: " + report::fixed(centre.y(), 3) + "}, " + report::fixed(1e3 * info.metres_per_unit, 3) +
        " mm a unit");
  }
  if (!info.settings.empty()) {
    say("    " + info.settings);
  }
}

/// One image. Throws Error where there is none.
void look_at(const std::string& name, sensors::DepthSource& source, const RigCamera& camera) {
  source.open();
  const sensors::SourceInfo& info = source.info();
  sensors::DepthReading reading;
  const double end_s = sensors::clock_now_s() + kPatience_s;
  while (sensors::clock_now_s() < end_s) {
    const sensors::Reading result = source.next(reading, end_s - sensors::clock_now_s());
    if (result == sensors::Reading::nothing) {
      continue;
    }
    if (result != sensors::Reading::got) {
      fail(name,
           ": opened, and then: ", result == sensors::Reading::ended ? "it ended without an image" : source.reason());
    }
    const double age_s = sensors::clock_now_s() - reading.time_s;
    std::string line = name + ": " + info.name + (info.serial.empty() ? "" : " (" + info.serial + ")") + ", " +
                       std::to_string(reading.depth.width_px) + " x " + std::to_string(reading.depth.height_px) +
                       " pixels, image of " + report::fixed(reading.time_s, 3) + " s" + ", " +
                       report::fixed(1e3 * age_s, 1) + " ms old" + ", by the clock of " + info.clock;
    if (const char* why = why_unusable(reading.depth, camera.intrinsics)) {
      fail(name, ": its image cannot be used: ", why);
    }
    try {
      monitor::refuse_other_images(info, camera.intrinsics);
      monitor::refuse_other_unit(reading.depth, camera);
    } catch (const Error& error) {
      fail(name, ": ", error.what());
    }
    DepthImage measured(camera.intrinsics.width_px, camera.intrinsics.height_px);
    normalise(with_stride(reading.depth), camera.rule, measured);
    const std::size_t pixels =
        static_cast<std::size_t>(measured.width_px()) * static_cast<std::size_t>(measured.height_px());
    const auto none = std::count(measured.data(), measured.data() + pixels, 0.0F);
    line += ", " + report::percent(1 - static_cast<double>(none) / static_cast<double>(pixels)) +
            " of its pixels have a reading";
    say(line);
    show_device(info);
    source.close();
    return;
  }
  fail(name, ": opened, and sent no image within ", kPatience_s, " s");
}

void look_at_joints(sensors::JointSource& source, const robot::RobotModel& model) {
  source.open();
  sensors::JointReading reading;
  const sensors::Reading result = source.next(reading, kPatience_s);
  if (result != sensors::Reading::got) {
    fail("joints: opened, and sent nothing within ", kPatience_s, " s ", source.reason());
  }
  std::string line = "joints: " + source.info().name + ", state of " + report::fixed(reading.time_s, 3) + " s:";
  std::string beyond;
  for (std::size_t i = 0; i < reading.q.size(); ++i) {
    const robot::Joint& joint = model.joints()[i];
    line += " " + joint.name + " " + report::fixed(reading.q[i], 3);
    if (!(reading.q[i] >= joint.lower && reading.q[i] <= joint.upper)) {
      beyond += " " + joint.name;
    }
  }
  say(line);
  if (!beyond.empty()) {
    fail("joints: beyond their limits:", beyond, ": degrees for radians, or another robot");
  }
  source.close();
}

void check(const std::string& file) {
  const cell::Cell cell = cell::load_cell(file);
  say(file + ": is read: " + std::to_string(cell.cameras.size()) + " cameras");
  const cell::CellSetup setup = cell::setup(cell);
  say(file + ": fits together: " + std::to_string(setup.parts.size()) + " parts are asked for");
  for (const std::string& line : cell::implausible(cell, setup)) {
    say("implausible: " + line);
  }
  monitor::Sources sources = monitor::make_sources(cell, setup, monitor::ros2_node(cell));
  std::vector<std::string> failures;
  const auto attempt = [&](const auto& look) {
    try {
      look();
    } catch (const Error& error) {
      failures.emplace_back(error.what());
      say("failed: " + failures.back());
    }
  };
  for (std::size_t k = 0; k < sources.cameras.size(); ++k) {
    attempt([&] { look_at(cell.cameras[k].name, *sources.cameras[k], setup.rig.cameras[k]); });
  }
  if (sources.joints != nullptr) {
    attempt([&] { look_at_joints(*sources.joints, setup.robot->model); });
  }
  // As run begins.
  attempt([&] {
    const monitor::Monitor begun(setup, monitor::monitor_settings(cell), std::move(sources));
    if (cell.outputs.udp) {
      (void)monitor::udp_output(*cell.outputs.udp);
    }
  });
  if (!failures.empty()) {
    fail(failures.size(), failures.size() == 1 ? " thing" : " things",
         " would keep the cell from running, the first: ", failures.front());
  }
}

/// Which model of docs/sensor-models.md is of it; empty: none by its name.
std::string sensor_of(const sensors::FoundCamera& camera) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kModels{
      {{"D415", "realsense_d415"}, {"D435", "realsense_d435"}, {"D455", "realsense_d455"}, {"Kinect", "kinect_v1"}}};
  for (const auto& [name, model] : kModels) {
    if (camera.name.find(name) != std::string::npos) {
      return std::string(model);
    }
  }
  return {};
}

/// Exclusively: what somebody has written is not written over.
std::FILE* new_file(const std::string& file) {
  std::FILE* const out = std::fopen(file.c_str(), "wxe");
  if (out == nullptr) {
    std::error_code ignored;
    fail(file, std::filesystem::exists(file, ignored)
                   ? ": is there already, and is not written over: choose another name"
                   : ": cannot be written: is its folder there?");
  }
  return out;
}

void write_new(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    (void)std::fclose(new_file(file));  // says why, before anything is looked for
  }
  const sensors::FoundCameras found = sensors::find_cameras();
  std::vector<cell::ExampleCamera> cameras;
  for (const sensors::FoundCamera& camera : found.cameras) {
    cameras.push_back({.name = "camera" + std::to_string(cameras.size() + 1),
                       .source = camera.source,
                       .serial = camera.serial,
                       .intrinsics = camera.intrinsics,
                       .metres_per_unit = camera.metres_per_unit,
                       .is_calibrated = camera.is_calibrated,
                       .sensor = sensor_of(camera),
                       .comment = camera.name});
  }
  std::FILE* const out = new_file(file);
  const std::string text = cell::example_cell(cameras);
  const bool written = std::fputs(text.c_str(), out) >= 0;
  if (std::fclose(out) != 0 || !written) {
    fail(file, ": cannot be written");
  }
  for (const sensors::FoundCamera& camera : found.cameras) {
    say("found " + camera.source + ": " + camera.name + (camera.serial.empty() ? "" : " (" + camera.serial + ")"));
  }
  for (const std::string& note : found.notes) {
    say("not asked: " + note);
  }
  if (cameras.empty()) {
    say("no camera with a driver was found: the cameras in the file are topics of ROS 2, as an example");
  }
  say(file + ": written: " + (cameras.empty() ? "two RealSense D435" : std::to_string(cameras.size()) + " cameras") +
      " and a Panda; edit it, then depthgrid cell check " + file);
}

}  // namespace

void add_cell_command(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("cell", "the file that describes a robot cell: look at it, check it, begin one");
  command.require_subcommand(1);
  command.footer(
      "Examples:\n"
      "  depthgrid cell new cell.yaml\n"
      "  depthgrid cell check cell.yaml\n"
      "  depthgrid cell show cell.yaml\n"
      "docs/run.md says what each value means.");
  const auto add = [&](const char* name, const char* what, const char* argument, void (*work)(const std::string&)) {
    const auto file = std::make_shared<std::string>();
    CLI::App& sub = *command.add_subcommand(name, what);
    sub.add_option("FILE", *file, argument)->required();
    sub.footer(std::string("Example:\n  depthgrid cell ") + name + " cell.yaml");
    sub.callback([file, work] { work(*file); });
  };
  add("show", "every value with its unit and where it comes from", "a cell file", show);
  add("check", "what is missing or implausible; opens each camera and the joints once", "a cell file", check);
  add("new", "writes a commented cell file: two RealSense D435 and a Panda", "the file to write; it must not be there",
      write_new);
}

}  // namespace depthgrid::program
