// Names in a file must not steer the terminal that shows a message about them.
#include "runtime/base/printable.h"

#include <gtest/gtest.h>

#include "runtime/base/error.h"

namespace voyager::printable_test {
namespace {

TEST(Printable, TextStaysAsItIs) {
  for (const char* text : {"", "a/b.ply: offset 3", "größe 12 m², \\n", "点群", "🛰"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ControlCharactersBecomeTheirCodes) {
  EXPECT_EQ(printable("\x1b[31mred\x7f\n"), "\\x1b[31mred\\x7f\\x0a");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b[2J"), "\\xc2\\x9b[2J") << "CSI of one character";
}

TEST(Printable, BytesThatAreNotUtf8BecomeTheirCodes) {
  EXPECT_EQ(printable("\x9b[2J"), "\\x9b[2J") << "CSI of 8 bits";
  EXPECT_EQ(printable("\xe7\x82"), "\\xe7\\x82") << "cut off";
  EXPECT_EQ(printable("\xc0\x9b\xff"), "\\xc0\\x9b\\xff");
}

TEST(Printable, EveryMessageOfAnErrorIs) {
  EXPECT_STREQ(Error(ErrorCode::io, "a\x1b]0;b").what(), "a\\x1b]0;b");
}

}  // namespace
}  // namespace voyager::printable_test
