#include "tools/byte_size.h"

#include <gtest/gtest.h>

namespace voyager::byte_size_test {
namespace {

using tools::size_text;

TEST(ByteSize, HasTheUnitThatPeopleReadAndAtMostThreeDigits) {
  EXPECT_EQ(size_text(0), "0 bytes");
  EXPECT_EQ(size_text(999), "999 bytes");
  EXPECT_EQ(size_text(1000), "1.00 kB");
  EXPECT_EQ(size_text(3424), "3.42 kB");
  EXPECT_EQ(size_text(9'994), "9.99 kB");
  EXPECT_EQ(size_text(9'995), "10.0 kB");
  EXPECT_EQ(size_text(999'499), "999 kB");
  EXPECT_EQ(size_text(999'500), "1.00 MB");
  EXPECT_EQ(size_text(79'100'000), "79.1 MB");
  EXPECT_EQ(size_text(25'276'502'016), "25.3 GB");
  EXPECT_EQ(size_text(UINT64_MAX), "18446744 TB");
}

}  // namespace
}  // namespace voyager::byte_size_test
