// Hosts that were compiled in another way than this program: with kept headers, without exceptions.
#include <gtest/gtest.h>

#include <fstream>

#include "kept_host.h"
#include "no_exceptions.h"
#include "tests/headless/scene_bytes.h"
#include "tests/support/test_support.h"

namespace hosts_test {
namespace {

class Hosts : public ::testing::Test {
 protected:
  Hosts() { std::ofstream(scene, std::ios::binary) << ply_bytes(3000); }

  const voyager::test::TempFolder folder;
  const std::string scene = folder.file("scene.ply");
};

TEST_F(Hosts, CompiledAgainstTheKeptHeadersRun) {
  EXPECT_STREQ(run_kept_host(scene.c_str()), nullptr);
}

TEST_F(Hosts, WithoutExceptionsGetResults) {
  EXPECT_STREQ(use_without_exceptions(scene.c_str()), nullptr);
}

}  // namespace
}  // namespace hosts_test
