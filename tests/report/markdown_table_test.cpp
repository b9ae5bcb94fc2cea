// Tables for Markdown.
#include "report/markdown_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/thrown_message.hpp"

namespace depthgrid::report {
namespace {

TEST(MarkdownTable, HasALineForTheHeadAndOneARow) {
  MarkdownTable table({"a", "b"});
  EXPECT_EQ(table.text(), "| a | b |\n|---|---|");
  table.row({"1", "2"});
  EXPECT_EQ(table.text(), "| a | b |\n|---|---|\n| 1 | 2 |");
}

TEST(MarkdownTable, RefusesRowsOfAnotherLength) {
  MarkdownTable table({"a", "b"});
  EXPECT_THAT(test::thrown_message([&] { table.row({"1"}); }), ::testing::HasSubstr("1 cells under a head of 2"));
  EXPECT_EQ(table.text(), "| a | b |\n|---|---|") << "nothing of it is kept";
}

}  // namespace
}  // namespace depthgrid::report
