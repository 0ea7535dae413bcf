// samples/vulkan_minimal draws what `voyager render` draws, and says why it cannot.
#include <cstdlib>

#include "../headless/scene_bytes.h"
#include "tests/command_line/program.h"
#include "tests/support/needs.h"
#include "tests/support/pictures.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace vulkan_minimal_test {
namespace {

class VulkanMinimal : public ::testing::Test {
 protected:
  // A software Vulkan that is unloaded leaves some bytes behind. tests/support/lsan.supp knows them
  // by who called it, which takes whole stacks.
  static void SetUpTestSuite() {
    const char* options = std::getenv("ASAN_OPTIONS");
    setenv("ASAN_OPTIONS",
           ((options == nullptr ? "" : std::string(options) + ":") + "fast_unwind_on_malloc=0")
               .c_str(),
           1);
  }
  void SetUp() override {
    write_bytes(folder_.file("scene.ply"), ply_bytes(800));
    write_bytes(folder_.file("cameras.json"),
                R"([{"id": 0, "width": 640, "height": 360, "position": [1, -2, -12],
                    "rotation": [[1,0,0],[0,1,0],[0,0,1]], "fx": 320, "fy": 320}])");
  }
  Outcome minimal(const std::string& scene) const {
    return run("vulkan_minimal " + folder_.file(scene) + " " + folder_.file("out.ppm") +
               " 1 -2 -12");
  }
  TempFolder folder_;
};

TEST_F(VulkanMinimal, DrawsWhatVoyagerRenders) {
  const Outcome drawn = minimal("scene.ply");
  if (drawn.output.find("found no Vulkan device") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, "no Vulkan device");
  ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
  const Outcome reference =
      run("voyager render " + folder_.file("scene.ply") + " --cameras " +
          folder_.file("cameras.json") + " --backend cpu -o " + folder_.file("out.png"));
  ASSERT_EQ(reference.exit_code, 0) << reference.output;
  const Picture expected = read_png(folder_.file("out.png"));
  const std::string bytes = file_bytes(folder_.file("out.ppm"));
  const std::string header = "P6 640 360 255\n";
  ASSERT_EQ(bytes.substr(0, header.size()), header);
  Picture picture{640, 360, {}};
  for (size_t i = header.size(); i < bytes.size(); ++i)
    picture.values.push_back(static_cast<uint8_t>(bytes[i]));
  EXPECT_LE(largest_difference(picture, expected), 1);
}

TEST_F(VulkanMinimal, SaysWhyItCannot) {
  const Outcome missing = minimal("none.ply");
  if (missing.output.find("found no Vulkan device") != std::string::npos)
    VOYAGER_SKIP_WITHOUT(VULKAN, "no Vulkan device");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.output.find("VOY_ERROR_FILE_NOT_FOUND"), std::string::npos) << missing.output;
  EXPECT_EQ(run("vulkan_minimal").exit_code, 1);
}

}  // namespace
}  // namespace vulkan_minimal_test
}  // namespace voyager::test
