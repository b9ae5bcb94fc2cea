// Measures by how much the letter's evaluation and the corrected one over- and under-estimate distances, and writes
// the page about it:  depthgrid_letter_errors --output docs/letter-errors.md
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "lab/letter/letter_page.hpp"

namespace {

using Clock = std::chrono::steady_clock;

/// One line on a terminal with the time left; nothing elsewhere.
class Progress {
 public:
  explicit Progress(std::string what) : what_(std::move(what)) {}
  ~Progress() {
    if (shown_) {
      std::fprintf(stderr, "\r\033[K");
    }
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void operator()(int done, int total) {
    if (isatty(2) == 0 || done == 0) {
      return;
    }
    const double passed_s = std::chrono::duration<double>(Clock::now() - start_).count();
    std::fprintf(stderr, "\r\033[K%s: %d of %d, %.0f s left", what_.c_str(), done, total,
                 passed_s * (total - done) / done);
    shown_ = true;
  }

 private:
  std::string what_;
  Clock::time_point start_ = Clock::now();
  bool shown_ = false;
};

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace depthgrid::lab;
  std::uint64_t seed = 1;
  int scenes = 1000;
  int large_scenes = 100;
  std::vector<int> secondaries{1, 2, 3};
  int trials = 300;
  std::int64_t cases = 1'200'000;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string output;
  std::string json;
  CLI::App app{"Errors of the letter's distance evaluation against a proven interval, as a page."};
  app.add_option("--seed", seed, "first seed of all random cases")->capture_default_str();
  app.add_option("--scenes", scenes, "small scenes for each number of secondary cameras")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option("--large-scenes", large_scenes, "scenes with 640x480 pixels for each number of secondary cameras")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  app.add_option("--secondary", secondaries, "numbers of secondary cameras")
      ->delimiter(',')
      ->check(CLI::Range(0, 16))
      ->capture_default_str();
  app.add_option("--trials", trials, "trials for each kind of small object")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option("--cases", cases, "random cases for the formulas")->check(CLI::Range(600, 1'000'000'000));
  app.add_option("--threads", threads, "threads; the figures do not depend on them")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--output", output, "the page (Markdown); standard output when not given");
  app.add_option("--json", json, "the same figures as JSON");
  CLI11_PARSE(app, argc, argv);

  try {
    LetterErrors errors;
    errors.command = "depthgrid_letter_errors --seed " + std::to_string(seed) + " --scenes " + std::to_string(scenes) +
                     " --large-scenes " + std::to_string(large_scenes) + " --trials " + std::to_string(trials) +
                     (app.count("--secondary") > 0 ? " --secondary " + CLI::detail::join(secondaries, ",") : "") +
                     (app.count("--cases") > 0 ? " --cases " + std::to_string(cases) : "") +
                     " --output docs/letter-errors.md";
    errors.date = today();
    for (const int width_px : {0, 640}) {
      for (const int count : secondaries) {
        CampaignSettings settings{seed, width_px == 0 ? scenes : large_scenes, count, width_px, threads};
        if (settings.scenes > 0) {
          Progress progress((width_px == 0 ? "small scenes, " : "640x480 scenes, ") + std::to_string(count) +
                            " secondary");
          errors.campaigns.push_back(
              {settings, run_campaign(settings, [&](int done, int total) { progress(done, total); })});
        }
      }
    }
    errors.window = measure_window();
    errors.clamp = measure_clamp(seed, cases);
    errors.order = measure_order(seed, cases);
    {
      Progress progress("small objects");
      errors.vanishing = measure_vanishing(seed, trials, threads, [&](int done, int total) { progress(done, total); });
    }
    if (output.empty()) {
      write_page(errors, std::cout);
    } else {
      std::ofstream page(output);
      write_page(errors, page);
      if (!page.flush()) {
        std::cerr << "cannot write " << output << '\n';
        return 1;
      }
    }
    if (!json.empty()) {
      std::ofstream file(json);
      write_json(errors, file);
      if (!file.flush()) {
        std::cerr << "cannot write " << json << '\n';
        return 1;
      }
    }
  } catch (const std::exception& error) {
    std::cerr << "depthgrid_letter_errors: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
