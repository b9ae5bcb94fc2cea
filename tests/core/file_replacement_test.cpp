// What writing a file may replace.
#include "depthgrid/core/file_replacement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "depthgrid/core/error.hpp"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ReplaceableFile : public ::testing::Test {
 protected:
  ReplaceableFile() : folder_(fs::temp_directory_path() / ("depthgrid-target-" + std::to_string(::getpid()))) {
    fs::create_directory(folder_);
  }
  ~ReplaceableFile() override { fs::remove_all(folder_); }

  static std::string message(const fs::path& path) {
    try {
      return "no error: " + replaceable_file(path).string();
    } catch (const Error& error) {
      return error.what();
    }
  }
  fs::path folder_;
};

TEST_F(ReplaceableFile, AbsentAndRegularFilesAreThemselves) {
  EXPECT_EQ(replaceable_file(folder_ / "new"), folder_ / "new");
  std::ofstream(folder_ / "old") << "x";
  EXPECT_EQ(replaceable_file(folder_ / "old"), folder_ / "old");
}

TEST_F(ReplaceableFile, NothingIsLeftOfWhatWasNotFinished) {
  const auto entries = [&] { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); };
  {
    FileReplacement one(folder_ / "file");
    FileReplacement other(folder_ / "file");
    std::fputs("x", one.stream());
    EXPECT_EQ(entries(), 2) << "two writers have a name each";
  }
  EXPECT_EQ(entries(), 0);
}

/// As a signal handler does it: what is under way goes, what is finished and what others wrote stays.
TEST_F(ReplaceableFile, UnfinishedFilesCanBeRemovedFromOutside) {
  const auto entries = [&] { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); };
  std::ofstream(folder_ / "other.tmp") << "x";
  for (int turn = 0; turn < 40; ++turn) {  // more often than there are entries in the table
    FileReplacement finished(folder_ / "finished");
    std::fputs("y", finished.stream());
    finished.commit();
  }
  FileReplacement one(folder_ / "file");
  FileReplacement other(folder_ / "file");
  EXPECT_EQ(entries(), 4);
  remove_unfinished_files();
  EXPECT_EQ(entries(), 2);
  EXPECT_TRUE(fs::exists(folder_ / "finished"));
  EXPECT_TRUE(fs::exists(folder_ / "other.tmp"));
}

TEST_F(ReplaceableFile, ALinkStandsForItsTarget) {
  std::ofstream(folder_ / "target") << "x";
  fs::create_symlink("target", folder_ / "link");
  EXPECT_EQ(replaceable_file(folder_ / "link"), fs::canonical(folder_ / "target"));
}

TEST_F(ReplaceableFile, PipesDevicesAndFoldersStay) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(message(folder_ / "pipe"), HasSubstr("pipe: exists and is not a regular file, will not be replaced"));
  fs::create_symlink("pipe", folder_ / "link");
  EXPECT_THAT(message(folder_ / "link"), HasSubstr("link: exists and is not a regular file"));
  EXPECT_THAT(message("/dev/null"), HasSubstr("/dev/null: exists and is not a regular file"));
  EXPECT_THAT(message(folder_), HasSubstr("is not a regular file"));
}

}  // namespace
}  // namespace depthgrid
