// Room for what will be written is asked of a device, not of a file.
#include "runtime/base/output_path.h"

#include <gtest/gtest.h>
#include <sys/statvfs.h>

#include "runtime/base/error.h"
#include "tests/support/test_support.h"

namespace voyager::output_path_test {
namespace {

class RequireRoom : public testing::Test {
 protected:
  // That share of what is free now.
  uint64_t share(double of_free) const {
    struct statvfs info = {};
    EXPECT_EQ(::statvfs(folder.file("").c_str(), &info), 0);
    return static_cast<uint64_t>(of_free * static_cast<double>(info.f_bavail) *
                                 static_cast<double>(info.f_frsize));
  }
  Room room(const std::string& name, double of_free) const {
    return {folder.file(name), share(of_free), "a file " + name};
  }
  static std::string refusal(const std::vector<Room>& files) {
    try {
      require_room(files);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::io);
      return error.what();
    }
    return "";
  }

  const test::TempFolder folder;
};

TEST_F(RequireRoom, FilesOnOneDeviceNeedItTogether) {
  EXPECT_EQ(refusal({room("a", 0.6)}), "");
  EXPECT_EQ(refusal({room("a", 0.3), room("b", 0.3)}), "");
  const std::string both = refusal({room("a", 0.6), room("b", 0.6)});
  EXPECT_TRUE(both.starts_with(folder.file("a") + ": found ")) << both;
  EXPECT_NE(both.find("MB for a file a and a file b"), std::string::npos) << both;
}

TEST_F(RequireRoom, FilesOnOthersDoNot) {
  const Room elsewhere{"/proc/a", uint64_t{1} << 60, "nothing"};  // a device of no size
  EXPECT_EQ(refusal({room("a", 0.6), elsewhere}), "");
}

TEST_F(RequireRoom, AFolderIsOnADeviceAsItsFilesAre) {
  EXPECT_NE(refusal({room("", 0.6), room("b", 0.6)}), "");
}

}  // namespace
}  // namespace voyager::output_path_test
