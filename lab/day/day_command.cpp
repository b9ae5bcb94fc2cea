// depthgrid-lab day: what a day in the life of a running cell is planned as, and what came of it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/files/text_file.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "lab/commands.hpp"
#include "lab/day/day_cell.hpp"
#include "lab/day/day_check.hpp"
#include "lab/day/received_images.hpp"
#include "report/machine.hpp"
#include "report/number_text.hpp"

namespace depthgrid::lab {
namespace {

struct PlanOptions {
  std::string folder;
  double seconds = 600;
  std::uint64_t seed = 1;
  double begin_in_s = 3;
  bool no_faults = false;
  double image_rate_hz = 15;
  DayCell cell;
};

void plan_day(const PlanOptions& options) {
  const std::filesystem::path folder(options.folder);
  const std::filesystem::path cell_file = folder / "cell.yaml";
  const std::string text = day_cell(options.cell);
  const cell::Cell cell = cell::parse_cell(text, cell_file);
  std::vector<std::string> cameras;
  for (const cell::CameraEntry& camera : cell.cameras) {
    cameras.push_back(camera.name);
  }
  DayPlan plan;
  plan.begin_s = sensors::clock_now_s() + options.begin_in_s;
  plan.seconds = options.seconds;
  plan.image_rate_hz = options.image_rate_hz;
  if (!options.no_faults) {
    plan.faults = random_faults(cameras, options.seconds, options.seed);
  }
  std::filesystem::create_directories(folder);
  files::write_text_file(cell_file, text);
  write_plan(folder / "plan.json", plan);
  std::printf("%zu faults of %zu devices within %s s\n", plan.faults.size(), cameras.size() + 1,
              report::fixed(options.seconds, 0).c_str());
}

struct CheckOptions {
  std::string folder;
  std::string json;
  int truth_every = 1;
};

void check_day_in(const CheckOptions& options) {
  const std::filesystem::path folder(options.folder);
  const cell::Cell cell = cell::load_cell(folder / "cell.yaml");
  const cell::CellSetup setup = cell::setup(cell);
  const DayInput input{
      .cell = cell, .setup = setup, .plan = read_plan(folder / "plan.json"), .truth_every = options.truth_every};
  std::ifstream answers(folder / "answers.jsonl");
  if (!answers) {
    fail((folder / "answers.jsonl").string(), ": cannot be read");
  }
  std::ifstream memory(folder / "memory.txt");
  const DayReport report = check_day(input, answers, memory);
  Json json;
  json["machine"] = report::machine_line("both");
  json["faults_planned"] = input.plan.faults.size();
  json.update(to_json(report));
  if (!options.json.empty()) {
    write_json_file(options.json, json);
  }
  const std::string table = to_markdown(report);
  std::printf("%s\n", table.c_str());
  std::printf(
      "%s s, %llu answers, %llu distances compared: %llu above the truth (by up to %s m), %llu with an obstacle in the "
      "layer or a pocket only; %llu answers had to stop, %llu did not; longest time between answers %s ms; from "
      "exposure "
      "to answer median %s, 99.9 %% %s ms; memory %s MB, grown by %s MB, %s MB an hour\n",
      report::fixed(report.seconds, 1).c_str(), static_cast<unsigned long long>(report.answers),
      static_cast<unsigned long long>(report.compared), static_cast<unsigned long long>(report.over_estimates),
      report::fixed(report.largest_excess_m, 4).c_str(), static_cast<unsigned long long>(report.unclaimed),
      static_cast<unsigned long long>(report.blind), static_cast<unsigned long long>(report.not_stopped),
      report::fixed(1e3 * report.longest_gap_s, 1).c_str(), report::fixed(1e3 * report.latency_s.median(), 1).c_str(),
      report::fixed(1e3 * report.latency_s.quantile(0.999), 1).c_str(), report::fixed(report.memory_mb, 1).c_str(),
      report::fixed(report.memory_growth_mb, 2).c_str(), report::fixed(report.memory_mb_per_hour, 2).c_str());
  for (const std::string& finding : report.findings) {
    std::printf("  %s\n", finding.c_str());
  }
  const std::vector<std::string> failures = report.failures();
  if (!failures.empty()) {
    std::string all;
    for (const std::string& failure : failures) {
      all += (all.empty() ? "" : "; ") + failure;
    }
    fail(options.folder, ": ", all);
  }
}

struct ImagesOptions {
  std::string answers;
  double leave_out_s = 3;
  double least_hz = 0;
};

void count_images(const ImagesOptions& options) {
  std::ifstream answers(options.answers);
  if (!answers) {
    fail(options.answers, ": cannot be read");
  }
  const Received received = received_images(answers, options.leave_out_s);
  std::printf("%s s, %zu answers, %s of them stop\n", report::fixed(received.seconds, 1).c_str(), received.answers,
              report::percent_of(static_cast<double>(received.stopped), static_cast<double>(received.answers)).c_str());
  std::printf(
      "| camera | images a second | old ms when first asked: median | 99.9 %% | longest without ms | answers late |\n"
      "|---|---|---|---|---|---|\n");
  for (const ReceivedImages& camera : received.cameras) {
    const double rate_hz = static_cast<double>(camera.images) / received.seconds;
    std::printf("| %s | %s | %s | %s | %s | %s |\n", camera.camera.c_str(), report::fixed(rate_hz, 1).c_str(),
                report::fixed(1e3 * camera.age_s.median(), 1).c_str(),
                report::fixed(1e3 * camera.age_s.quantile(0.999), 1).c_str(),
                report::fixed(1e3 * camera.between_s.largest(), 0).c_str(), report::percent(camera.late_share).c_str());
    if (!(rate_hz >= options.least_hz)) {
      fail("of ", camera.camera, " ", report::fixed(rate_hz, 2), " images a second were used, must be at least ",
           options.least_hz);
    }
  }
}

}  // namespace

void add_day_command(CLI::App& app) {
  CLI::App* const day = app.add_subcommand("day", "a day in the life of a running cell: its plan, and what came of it");
  day->require_subcommand(1);
  const auto plan = std::make_shared<PlanOptions>();
  CLI::App* const plan_command =
      day->add_subcommand("plan", "writes FOLDER/cell.yaml and FOLDER/plan.json: a cell on topics, and random faults");
  plan_command->add_option("FOLDER", plan->folder)->required();
  plan_command->add_option("--seconds", plan->seconds)->check(CLI::Range(1.0, 1e6))->capture_default_str();
  plan_command->add_option("--seed", plan->seed, "of the faults")->capture_default_str();
  plan_command->add_option("--begin-in", plan->begin_in_s, "seconds from now until the cell's time is 0")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  plan_command->add_option("--rate", plan->image_rate_hz, "images a second")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  plan_command->add_flag("--no-faults", plan->no_faults, "nothing fails");
  plan_command->add_option("--cameras", plan->cell.cameras)->check(CLI::Range(1, 8))->capture_default_str();
  plan_command->add_option("--width", plan->cell.width_px)->check(CLI::Range(16, 4096))->capture_default_str();
  plan_command->add_option("--height", plan->cell.height_px)->check(CLI::Range(16, 4096))->capture_default_str();
  plan_command->add_option("--sensor", plan->cell.sensor, "a sensor model")->capture_default_str();
  plan_command->add_option("--ask-rate", plan->cell.rate_hz)->check(CLI::Range(1.0, 10000.0))->capture_default_str();
  plan_command->add_option("--domain", plan->cell.domain)->check(CLI::Range(0, 232))->capture_default_str();
  plan_command->add_option("--port", plan->cell.port, "of the datagrams; 0: none")->capture_default_str();
  plan_command->add_option("--answers", plan->cell.answers, "JSON lines, beside the cell file (none)");
  plan_command->add_option("--time-error", plan->cell.time_error_s, "between the devices' clocks and ours, at most")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  plan_command->callback([plan] { plan_day(*plan); });
  const auto check = std::make_shared<CheckOptions>();
  CLI::App* const check_command = day->add_subcommand(
      "check", "holds FOLDER/answers.jsonl against the plan and the truth; ends with 1 where a rule is broken");
  check_command->add_option("FOLDER", check->folder)->required();
  check_command->add_option("--json", check->json, "writes the figures");
  check_command->add_option("--truth-every", check->truth_every, "every so many answers are held against the truth")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  const auto images = std::make_shared<ImagesOptions>();
  CLI::App* const images_command = day->add_subcommand(
      "images", "how many images of each camera the JSON lines of a run stand on, and how old they were");
  images_command->add_option("ANSWERS", images->answers)->required();
  images_command->add_option("--leave-out", images->leave_out_s, "seconds at the beginning")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  images_command->add_option("--least", images->least_hz, "images a second of each camera; fewer end with 1")
      ->check(CLI::Range(0.0, 1e4))
      ->capture_default_str();
  images_command->callback([images] { count_images(*images); });
  check_command->callback([check] { check_day_in(*check); });
}

}  // namespace depthgrid::lab
