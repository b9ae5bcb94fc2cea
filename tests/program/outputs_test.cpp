// Outputs that are inputs, and outputs that somebody stopped.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kPoint = "--point 0.2,0,1.7 --sensor ideal ";

/// All bytes of all files in the folder, by name.
std::string everything(const TemporaryFolder& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    files.push_back(entry.path().string() + (entry.is_regular_file() ? ": " + read_bytes(entry.path()) : ""));
  }
  std::sort(files.begin(), files.end());
  std::string all;
  for (const std::string& file : files) {
    all += file + "\n";
  }
  return all;
}

struct Overwriting {
  std::string arguments;
  std::string message;
  std::function<void(const TemporaryFolder&)> prepare = nullptr;
};

TEST(Outputs, ThatAreInputsAreRefusedBeforeWorkBegins) {
  const auto pictures_in_recording = [](const TemporaryFolder& f) {
    auto file = wall_rig();
    file.depth_files = {"frame_%04d.png", "right_%03d.png"};
    files::save_rig(file, f / "rig.json");
    for (int frame = 5; frame < 7; ++frame) {
      fs::copy(f / files::depth_file_name("left_%03d.png", frame), f / files::depth_file_name("frame_%04d.png", frame));
    }
  };
  for (const Overwriting& c : std::vector<Overwriting>{
           {"distances rig.json " + kPoint + "--output rig.json",
            "--output rig.json is the rig file rig.json, an input that would be overwritten; name another file"},
           {"distances . " + kPoint + "--output rig.json", "is the rig file ./rig.json"},
           {"distances . " + kPoint + "--output ./x/../rig.json", "is the rig file",
            [](const TemporaryFolder& f) { fs::create_directory(f / "x"); }},
           {"distances . " + kPoint + "--output link", "--output link is the rig file",
            [](const TemporaryFolder& f) { fs::create_symlink("rig.json", f / "link"); }},
           {"distances . " + kPoint + "--output hard", "--output hard is the rig file",
            [](const TemporaryFolder& f) { fs::create_hard_link(f / "rig.json", f / "hard"); }},
           {"distances link.json " + kPoint + "--output rig.json", "--output rig.json is the rig file link.json",
            [](const TemporaryFolder& f) { fs::create_symlink("rig.json", f / "link.json"); }},
           {"distances . " + kPoint + "--output other/rig.json", "--output other/rig.json is the rig file",
            [](const TemporaryFolder& f) { fs::create_directory_symlink(".", f / "other"); }},
           {"distances . " + kPoint + "--output right_006.png", "is the depth image ./right_006.png"},
           {"distances . --frames 5 " + kPoint + "--output right_006.png", "is the depth image ./right_006.png"},
           {"info . --frames 5 --output left_006.png", "is the depth image ./left_006.png"},
           {"distances . --points p.csv --sensor ideal --output p.csv", "is the file of control points p.csv",
            [](const TemporaryFolder& f) { (void)f.write("p.csv", "hand,0.2,0,1.7\n"); }},
           {"distances . --point 0.2,0,1.7 --method letter --map wall.map --output wall.map",
            "is the map file wall.map",
            [](const TemporaryFolder& f) { (void)run_command("map build . --count 200 --output wall.map", f); }},
           {"distances . " + kPoint + "--pictures .",
            "the picture of --pictures ./frame_0005.png is the depth image ./frame_0005.png", pictures_in_recording},
           {"distances . " + kPoint + "--pictures again", "is the depth image ./frame_0005.png",
            [&](const TemporaryFolder& f) {
              pictures_in_recording(f);
              fs::create_directory_symlink(".", f / "again");
            }},
           {"distances . " + kPoint + "--pictures p --output p/frame_0005.png", "are the same file; name two",
            [](const TemporaryFolder& f) { fs::create_directory(f / "p"); }},
           {"info . --output rig.json", "--output rig.json is the rig file ./rig.json"},
           {"info . --output left_005.png", "is the depth image ./left_005.png"},
           {"map build . --output rig.json", "--output rig.json is the rig file ./rig.json"},
           {"rig from rig.json --output ./rig.json", "--output ./rig.json is the calibration rig.json"},
           {"map build rig.json --output ./rig.json", "is the rig file rig.json"},
       }) {
    const TemporaryFolder folder;
    write_wall(folder);
    if (c.prepare) {
      c.prepare(folder);
    }
    const std::string before = everything(folder);
    const auto result = run_command(c.arguments, folder);
    EXPECT_EQ(result.exit_code, 2) << c.arguments << "\n" << result.err;
    EXPECT_THAT(result.err, HasSubstr(c.message)) << c.arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "") << c.arguments;
    EXPECT_EQ(everything(folder), before) << c.arguments;
  }
}

TEST(Outputs, ThatReplaceWhatIsNoInputAreFine) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("answers.csv", "old");
  EXPECT_EQ(run_command("distances . " + kPoint + "--output answers.csv", folder).exit_code, 0);
  EXPECT_NE(read_bytes(folder / "answers.csv"), "old");
  EXPECT_EQ(run_command("distances . " + kPoint + "--frames 5 --output left_006.csv", folder).exit_code, 0);
}

/// The command on a recording of many frames, which takes some seconds.
class Stopped : public ::testing::Test {
 protected:
  static constexpr int kFrames = 3000;

  Stopped() {
    write_wall(folder_);
    auto file = wall_rig();
    file.frame_count = kFrames;
    files::save_rig(file, folder_ / "rig.json");
    for (int frame = 7; frame < 5 + kFrames; ++frame) {
      for (const std::string& pattern : file.depth_files) {
        fs::create_symlink(files::depth_file_name(pattern, 5), folder_ / files::depth_file_name(pattern, frame));
      }
    }
  }

  /// Starts it with standard error in a file; `ignored` is a signal that it inherits as ignored, 0: none.
  pid_t start(int ignored = 0) const {
    const pid_t child = ::fork();
    if (child == 0) {
      for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        (void)std::signal(signal, signal == ignored ? SIG_IGN : SIG_DFL);
      }
      const int err = ::open((folder_ / "err").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
      (void)::dup2(err, STDERR_FILENO);
      (void)::chdir(folder_.path().c_str());
      ::execl(DEPTHGRID_COMMAND, DEPTHGRID_COMMAND, "distances", ".", "--sensor", "ideal", "--point", "0.2,0,1.7",
              "--output", "answers.csv", static_cast<char*>(nullptr));
      ::_exit(99);
    }
    return child;
  }

  [[nodiscard]] int unfinished() const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      count += name.find(".tmp") != std::string::npos || name.find(".part") != std::string::npos ? 1 : 0;
    }
    return count;
  }

  void wait_until_it_writes() const {
    for (int turn = 0; turn < 3000 && unfinished() == 0; ++turn) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_EQ(unfinished(), 1);
  }

  TemporaryFolder folder_;
};

TEST_F(Stopped, LeavesNothingUnfinishedAndSaysSo) {
  for (const auto& [signal, name] :
       {std::pair(SIGINT, "SIGINT"), std::pair(SIGTERM, "SIGTERM"), std::pair(SIGHUP, "SIGHUP")}) {
    (void)folder_.write("answers.csv", "old");
    const pid_t child = start();
    wait_until_it_writes();
    ASSERT_EQ(::kill(child, signal), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << name;
    EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    EXPECT_EQ(read_bytes(folder_ / "err"),
              std::string("depthgrid: stopped by ") + name + "; unfinished output was removed\n");
    EXPECT_EQ(unfinished(), 0) << name;
    EXPECT_EQ(read_bytes(folder_ / "answers.csv"), "old") << name;
  }
}

TEST_F(Stopped, NotByASignalThatWasIgnored) {
  const pid_t child = start(SIGHUP);
  wait_until_it_writes();
  ASSERT_EQ(::kill(child, SIGHUP), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, WNOHANG), 0) << "it goes on, as nohup wants it";
  ASSERT_EQ(::kill(child, SIGTERM), 0);
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
  EXPECT_EQ(unfinished(), 0);
}

}  // namespace
}  // namespace depthgrid::test
