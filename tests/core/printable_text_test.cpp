// Text that may reach a terminal: nothing in it steers the terminal.
#include "depthgrid/core/printable_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace depthgrid {
namespace {

TEST(PrintableText, WhatPrintsStaysAsItIs) {
  for (const std::string text :
       {"", "left camera", "C:\\data\\rig.json", "\xc3\xbc \xe2\x82\xac \xf0\x9f\xa4\x96", "'\"`~"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_TRUE(is_printable(text)) << text;
  }
}

struct Steering {
  std::string text;
  std::string written;
};

TEST(PrintableText, WhatSteersATerminalIsWrittenOut) {
  for (const auto& [text, written] : {
           Steering{"\x1b[2J", "\\x1b[2J"}, Steering{std::string("a\0b", 3), "a\\x00b"},
           Steering{"one\ntwo\r\tthree\x7f", "one\\ntwo\\r\\tthree\\x7f"},
           Steering{"\xc2\x9b"
                    "31m",
                    "\\xc2\\x9b31m"},  // C1: CSI in UTF-8
           Steering{"\x9b"
                    "31m",
                    "\\x9b31m"},  // CSI as a byte
           Steering{"a\xe2\x80\xae"
                    "b",
                    "a\\xe2\\x80\\xaeb"},  // turns the direction
           Steering{"a\xe2\x80\xa8"
                    "b",
                    "a\\xe2\\x80\\xa8b"},                         // ends a line
           Steering{"\xc0\x9b", "\\xc0\\x9b"},                    // overlong
           Steering{"\xe0\x80\x9b", "\\xe0\\x80\\x9b"},           // overlong
           Steering{"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // a surrogate
           Steering{"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // beyond Unicode
           Steering{"\xe2\x82", "\\xe2\\x82"},                    // cut off
       }) {
    EXPECT_EQ(printable(text), written);
    EXPECT_FALSE(is_printable(text)) << written;
  }
}

TEST(PrintableText, EveryPairOfBytesIsHarmlessAfterwards) {
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second) {
      const std::string text{static_cast<char>(first), static_cast<char>(second)};
      const std::string written = printable(text);
      EXPECT_TRUE(is_printable(written)) << first << " " << second;
      EXPECT_EQ(is_printable(text), written == text) << first << " " << second;
      for (const char c : written) {
        const auto code = static_cast<unsigned char>(c);
        EXPECT_TRUE(code >= 0x20 && code != 0x7F) << first << " " << second;
      }
    }
  }
}

TEST(PrintableText, AnExcerptIsShortAndWhole) {
  EXPECT_EQ(printable_excerpt("short"), "short");
  EXPECT_EQ(printable_excerpt(std::string(59, 'a') + "\xc3\xbc" + std::string(50, 'b')), std::string(59, 'a') + "...");
}

}  // namespace
}  // namespace depthgrid
