// The folder an experiment leaves, and that nothing is left where it fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "depthgrid/core/error.hpp"
#include "files/temporary_folder.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "report/number_text.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::experiments {
namespace {

using ::testing::HasSubstr;

void small_run(const Options& options, ExperimentReport& report) {
  options.progress(1, 1);
  report.headline("It is 3 mm.");
  report.figures()["length_m"] = 0.003;
  report.picture("small.png", report::Canvas(20, 10), "nothing");
  report.frame(report::Canvas(20, 10));
  report.frame(report::Canvas(20, 10));
}

void failing_run(const Options& options, ExperimentReport& report) {
  small_run(options, report);
  fail("half-way");
}

TEST(ExperimentReport, HoldsFiguresPicturesAndWhatWasRun) {
  const test::TemporaryFolder folder;
  Options options;
  options.out = folder / "report";
  options.seed = 7;
  options.command_line = "depthgrid-lab experiment small --seed 7";
  const std::string text = run_experiment({"small", "a small one", small_run}, options);
  EXPECT_THAT(text, HasSubstr("It is 3 mm.\n"));
  EXPECT_THAT(text, HasSubstr("report.md"));
  const auto json = nlohmann::json::parse(test::read_bytes(folder / "report/figures.json"));
  EXPECT_EQ(json["about"]["experiment"], "small");
  EXPECT_EQ(json["about"]["command"], options.command_line);
  EXPECT_EQ(json["about"]["seed"], 7);
  EXPECT_EQ(json["figures"]["length_m"], 0.003);
  EXPECT_THAT(json["about"]["machine"].get<std::string>(), HasSubstr("cores"));
  EXPECT_EQ(json["about"]["started"].get<std::string>().size(), std::string("2026-01-01T00:00:00Z").size());
  EXPECT_THAT(test::read_bytes(folder / "report/report.md"), HasSubstr("![small.png](small.png)"));
  EXPECT_THAT(test::read_bytes(folder / "report/small.png"), HasSubstr("PNG"));
  EXPECT_THAT(test::read_bytes(folder / "report/frame-0002.png"), HasSubstr("PNG"));
  EXPECT_THAT(text, HasSubstr("small.png, frame-0001.png to frame-0002.png"));
}

TEST(ExperimentReport, NothingIsLeftWhereTheExperimentFails) {
  const test::TemporaryFolder folder;
  Options options;
  options.out = folder / "report";
  EXPECT_EQ(test::thrown_message([&] {
              (void)run_experiment({"failing", "fails", failing_run}, options);
            }),
            "half-way");
  EXPECT_FALSE(std::filesystem::exists(options.out));
}

TEST(ExperimentReport, WrongFoldersAreRefusedBeforeTheRun) {
  const test::TemporaryFolder folder;
  (void)folder.write("file", "x");
  const auto message = [](const std::filesystem::path& out) {
    Options options;
    options.out = out;
    return test::thrown_message([&] { (void)run_experiment({"failing", "fails", failing_run}, options); });
  };
  EXPECT_THAT(message(folder / "file"), HasSubstr("it is a file"));
  EXPECT_THAT(message(folder / "file/report"), HasSubstr("file is a file"));
  EXPECT_THAT(message(folder / "none/report"), HasSubstr("there is no folder"));
  std::filesystem::create_directories(folder / "taken/report.md");
  EXPECT_THAT(message(folder / "taken"), HasSubstr("report.md is a folder"));
  EXPECT_THAT(message(""), HasSubstr("--out"));
}

TEST(NumberText, SharesInPercentAndNothingForNaN) {
  EXPECT_EQ(report::percent(0.1234), "12.3 %");
  EXPECT_EQ(report::fixed(std::numeric_limits<double>::quiet_NaN(), 1), "-");
}

}  // namespace
}  // namespace depthgrid::experiments
