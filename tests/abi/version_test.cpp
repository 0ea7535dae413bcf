// Which hosts a library serves, in versions that are not out yet too.
#include "plugin/version.h"

#include <gtest/gtest.h>
#include <voyager/voyager.h>

namespace version_test {
namespace {

using voyager::serves;

TEST(Version, LowerMinorsOfTheSameMajorAreServed) {
  const uint32_t library = VOY_MAKE_VERSION(2, 3, 0);
  for (const uint32_t minor : {0u, 2u, 3u})
    EXPECT_TRUE(serves(library, VOY_MAKE_VERSION(2, minor, 9))) << minor;
  EXPECT_FALSE(serves(library, VOY_MAKE_VERSION(2, 4, 0)));
  for (const uint32_t major : {0u, 1u, 3u, 1023u})
    EXPECT_FALSE(serves(library, VOY_MAKE_VERSION(major, 3, 0))) << major;
}

}  // namespace
}  // namespace version_test
