// Unreal finds the module where the plugin's description says, and before it makes its device.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/command_line/program.h"

namespace voyager::test {
namespace unreal_guide_test {
namespace {

TEST(UnrealGuide, TheDescriptionNamesTheModuleAndItsPhase) {
  const std::string folder = VOYAGER_SOURCE_DIR "/samples/unreal_plugin/";
  const auto plugin = nlohmann::json::parse(file_bytes(folder + "Voyager.uplugin"));
  ASSERT_EQ(plugin["Modules"].size(), 1u);
  const auto& module = plugin["Modules"][0];
  EXPECT_EQ(module["LoadingPhase"], "PostConfigInit") << "later, Unreal has made its device";
  const std::string name = module["Name"];
  const std::string build = file_bytes(folder + "Source/" + name + "/" + name + ".Build.cs");
  EXPECT_NE(build.find("class " + name + " : ModuleRules"), std::string::npos);
  const std::string source = file_bytes(folder + "Source/Voyager/Private/VoyagerModule.cpp");
  EXPECT_NE(source.find("IMPLEMENT_MODULE(FVoyagerModule, " + name + ")"), std::string::npos);
}

}  // namespace
}  // namespace unreal_guide_test
}  // namespace voyager::test
