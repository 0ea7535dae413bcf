// Numbers that hosts have compiled in, and the names that go with them.
#include <gtest/gtest.h>
#include <voyager/voyager.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace results_test {
namespace {

struct Pinned {
  int number;
  VoyResult result;
  const char* name;
};
#define VOYAGER_PIN(number, result) \
  Pinned {                          \
    number, result, #result         \
  }

TEST(Results, NumbersAndNamesArePinned) {
  const Pinned all[] = {VOYAGER_PIN(0, VOY_SUCCESS),
                        VOYAGER_PIN(1, VOY_INCOMPLETE),
                        VOYAGER_PIN(-1, VOY_ERROR_INVALID_ARGUMENT),
                        VOYAGER_PIN(-2, VOY_ERROR_INVALID_HANDLE),
                        VOYAGER_PIN(-3, VOY_ERROR_INVALID_STRUCTURE),
                        VOYAGER_PIN(-4, VOY_ERROR_INCOMPATIBLE_VERSION),
                        VOYAGER_PIN(-5, VOY_ERROR_UNSUPPORTED),
                        VOYAGER_PIN(-6, VOY_ERROR_OUT_OF_HOST_MEMORY),
                        VOYAGER_PIN(-7, VOY_ERROR_OVER_BUDGET),
                        VOYAGER_PIN(-8, VOY_ERROR_FILE_NOT_FOUND),
                        VOYAGER_PIN(-9, VOY_ERROR_IO),
                        VOYAGER_PIN(-10, VOY_ERROR_REFUSED_INPUT),
                        VOYAGER_PIN(-11, VOY_ERROR_DAMAGED_CHUNK),
                        VOYAGER_PIN(-12, VOY_ERROR_NO_DEVICE),
                        VOYAGER_PIN(-13, VOY_ERROR_BUSY),
                        VOYAGER_PIN(-14, VOY_ERROR_SCENE_CLOSED),
                        VOYAGER_PIN(-15, VOY_ERROR_INTERNAL),
                        VOYAGER_PIN(-16, VOY_ERROR_DEVICE_LOST),
                        VOYAGER_PIN(-17, VOY_ERROR_TIMEOUT)};
  for (const Pinned& pinned : all) {
    EXPECT_EQ(int{pinned.result}, pinned.number);
    EXPECT_STREQ(voyResultName(pinned.result), pinned.name);
  }
  // None that the list above lacks: the header's next number has no name.
  EXPECT_STREQ(voyResultName(static_cast<VoyResult>(-18)), "unknown VoyResult");
  EXPECT_STREQ(voyResultName(static_cast<VoyResult>(2)), "unknown VoyResult");
}

TEST(Results, StructureTypesArePinned) {
  const VoyStructureType all[] = {VOY_STRUCTURE_TYPE_DEVICE_DESC,
                                  VOY_STRUCTURE_TYPE_CAPABILITIES,
                                  VOY_STRUCTURE_TYPE_SCENE_DESC,
                                  VOY_STRUCTURE_TYPE_BYTE_SOURCE,
                                  VOY_STRUCTURE_TYPE_SCENE_INFO,
                                  VOY_STRUCTURE_TYPE_SCENE_NOTE,
                                  VOY_STRUCTURE_TYPE_VIEW_DESC,
                                  VOY_STRUCTURE_TYPE_TARGET_DESC,
                                  VOY_STRUCTURE_TYPE_FRAME,
                                  VOY_STRUCTURE_TYPE_FRAME_STATS,
                                  VOY_STRUCTURE_TYPE_ALLOCATOR,
                                  VOY_STRUCTURE_TYPE_FRAME_EYE,
                                  VOY_STRUCTURE_TYPE_INSTANCE_POSE,
                                  VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT,
                                  VOY_STRUCTURE_TYPE_VULKAN_PHYSICAL_DEVICE,
                                  VOY_STRUCTURE_TYPE_VULKAN_REQUIREMENTS,
                                  VOY_STRUCTURE_TYPE_VULKAN_DEVICE_DESC,
                                  VOY_STRUCTURE_TYPE_VULKAN_CAPABILITIES,
                                  VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_IMAGE,
                                  VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_SEMAPHORES,
                                  VOY_STRUCTURE_TYPE_VULKAN_TARGET_DESC,
                                  VOY_STRUCTURE_TYPE_VULKAN_IMAGE,
                                  VOY_STRUCTURE_TYPE_VULKAN_FRAME,
                                  VOY_STRUCTURE_TYPE_VULKAN_USE,
                                  VOY_STRUCTURE_TYPE_VULKAN_COPY,
                                  VOY_STRUCTURE_TYPE_VULKAN_DEPTH_LIMIT,
                                  VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DESC,
                                  VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DRAW,
                                  VOY_STRUCTURE_TYPE_TIME_BUDGET,
                                  VOY_STRUCTURE_TYPE_SCENE_STREAMING,
                                  VOY_STRUCTURE_TYPE_FRAME_STREAMING,
                                  VOY_STRUCTURE_TYPE_STREAMING_STATS,
                                  VOY_STRUCTURE_TYPE_SCENE_PROFILE,
                                  VOY_STRUCTURE_TYPE_OMISSION,
                                  VOY_STRUCTURE_TYPE_DEVICE_INFO,
                                  VOY_STRUCTURE_TYPE_VULKAN_REPROJECTION,
                                  VOY_STRUCTURE_TYPE_EXPERIMENT,
                                  VOY_STRUCTURE_TYPE_EXPERIMENT_CAPABILITIES,
                                  VOY_STRUCTURE_TYPE_EXPERIMENT_STATS,
                                  VOY_STRUCTURE_TYPE_INSTANCE};
  int number = 0;
  for (const VoyStructureType type : all) EXPECT_EQ(int{type}, ++number);
}

std::string text_of(const std::string& path) {
  std::ifstream file(VOYAGER_SOURCE_DIR + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Every enumerator has its number in the header.
TEST(Results, NumbersOfThePromisedHeadersAreTheBaseline) {
  std::string found;
  for (const char* header : {"voyager.h", "voyager_vulkan.h"}) {
    const std::string text = text_of(std::string("/plugin/include/voyager/") + header);
    const std::regex number(R"(\n +(VOY_\w+)\s*=\s*(-?\w+))");
    for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at)
      found += (*at)[1].str() + " " + (*at)[2].str() + "\n";
  }
  EXPECT_EQ(found, text_of("/tests/abi/numbers.txt"))
      << "a number never changes; a new one goes into numbers.txt";
  EXPECT_EQ(VOY_MAX_STAGES, 16);
}

TEST(Results, EachStageHasItsNameAndNoOtherNumberHasOne) {
  const char* names[] = {"search", "project", "sort", "bin", "rasterize", "resolve"};
  for (int i = 0; i < 6; ++i) EXPECT_STREQ(voyStageName(static_cast<VoyStage>(i)), names[i]);
  EXPECT_EQ(voyStageName(static_cast<VoyStage>(6)), nullptr);
  EXPECT_EQ(voyStageName(static_cast<VoyStage>(-1)), nullptr);
}

TEST(Results, VersionIsTheVersionFiles) {
  std::ifstream file(VOYAGER_SOURCE_DIR "/VERSION");
  uint32_t major = 0, minor = 0, patch = 0;
  char dot = 0;
  ASSERT_TRUE(file >> major >> dot >> minor >> dot >> patch);
  EXPECT_EQ(voyGetVersion(), VOY_MAKE_VERSION(major, minor, patch));
}

}  // namespace
}  // namespace results_test
