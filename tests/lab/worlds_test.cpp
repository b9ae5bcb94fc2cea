// The campaign of random worlds keeps its books: resumed or merged it is the same, and its tables find their page.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "depthgrid/core/error.hpp"
#include "lab/worlds/worlds_page.hpp"

namespace depthgrid::lab {
namespace {

using world::Broken;

std::string in_folder(const std::string& name) { return (std::filesystem::path(testing::TempDir()) / name).string(); }

std::string read(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

WorldsState played(std::uint64_t first, std::uint64_t end, Broken broken = Broken::none) {
  WorldsState state;
  for (std::uint64_t seed = first; seed < end; ++seed) {
    play_into(state, {seed, 0, broken}, "test");
  }
  return state;
}

/// What the file holds, less the time that it took.
std::string without_time(WorldsState state) {
  for (auto& [name, kind] : state.kinds) {
    kind.seconds = 0;
  }
  const std::string file = in_folder("worlds_without_time.json");
  write_worlds(file, state);
  return read(file);
}

TEST(Worlds, ResumedOrMergedIsTheSameAsInOneGo) {
  const std::string whole = without_time(played(3, 7));
  const std::string file = in_folder("worlds_part.json");
  write_worlds(file, played(3, 5));
  WorldsState resumed = read_worlds(file);
  EXPECT_EQ(resumed.of({}).seeds.next_missing(3), 5U);
  play_into(resumed, {5, 0, Broken::none}, "test");
  play_into(resumed, {6, 0, Broken::none}, "test");
  EXPECT_EQ(without_time(resumed), whole);
  WorldsState merged = played(5, 7);
  merged.add(read_worlds(file));
  EXPECT_EQ(without_time(merged), whole);
  EXPECT_THROW(merged.add(read_worlds(file)), Error);
  EXPECT_THROW(play_into(merged, {6, 0, Broken::none}, "test"), Error);
  EXPECT_THROW(static_cast<void>(read_worlds(in_folder("there_is_no_such_file.json"))), Error);
}

// A state that lost something must not pass for one in which nothing was above the truth.
TEST(Worlds, AStateThatIsNotWholeIsRefusedInOneLine) {
  const std::string file = in_folder("worlds_not_whole.json");
  const auto refusal = [&file](const std::string& text) {
    std::ofstream(file) << text;
    try {
      return "read, kinds " + std::to_string(read_worlds(file).kinds.size());
    } catch (const Error& error) {
      const std::string message = error.what();
      return message.substr(message.find(": ") + 2);
    }
  };
  const std::string is_none = "is no state of random worlds; one is written by --state";
  EXPECT_EQ(refusal(R"({"worlds": []})"), "read, kinds 0");
  EXPECT_EQ(refusal(R"({"worlds": [{}]})"), is_none + ": [json.exception.out_of_range.403] key 'options' not found");
  EXPECT_EQ(refusal(R"({"worlds": null})"), is_none + ": \"worlds\" must be a list");
  EXPECT_EQ(refusal(R"({"worlds": [)"), is_none);
  EXPECT_EQ(refusal(R"({"worlds": )" + std::string(200'000, '[')), "is nested deeper than 32 levels");
  write_worlds(file, played(3, 4));
  std::string text = read(file);
  const std::size_t row = text.find("\"all\"");
  ASSERT_NE(row, std::string::npos);
  EXPECT_EQ(refusal(text), "read, kinds 1");
  EXPECT_EQ(refusal(text.replace(row, 5, "\"ale\"")), is_none + ": the row \"all\" counts 0 worlds, the seeds are 1");
}

TEST(Worlds, OptionsAreReadAsTheyAreWritten) {
  for (const Broken broken : {Broken::none, Broken::clock}) {
    for (const int width_px : {0, 640}) {
      const world::WorldOptions options{17, width_px, broken};
      const std::string command = world::command_of(options);
      EXPECT_EQ(world::command_of(world::options_of(command)), command);
      EXPECT_EQ(world::options_of(command).broken, broken);
      EXPECT_EQ(world::options_of(command).width_px, width_px);
    }
  }
  EXPECT_THROW(static_cast<void>(world::options_of("--wrold 3")), Error);
  EXPECT_THROW(static_cast<void>(world::broken_of("faster than light")), Error);
}

TEST(Worlds, PutTheirTablesBetweenTheMarkers) {
  const std::string page = in_folder("worlds_page.md");
  std::ofstream(page) << "before\n" << kWorldsBegin << "\nold\n" << kWorldsEnd << "\nafter\n";
  WorldsState state = played(1, 3);
  state.add(played(1, 2, Broken::pose));
  write_worlds_tables(page, worlds_tables(state));
  const std::string text = read(page);
  EXPECT_EQ(text.rfind("before\n", 0), 0U);
  EXPECT_NE(text.find("| all | 2 | "), std::string::npos) << text;
  EXPECT_NE(text.find("| 40x30 to 96x72, pose | 1 | "), std::string::npos) << text;
  EXPECT_EQ(text.find("old"), std::string::npos);
  EXPECT_EQ(text.substr(text.size() - 6), "after\n");
}

}  // namespace
}  // namespace depthgrid::lab
