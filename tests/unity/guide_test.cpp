// The script in docs/unity.md calls what the plugin exports.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/command_line/program.h"

namespace voyager::test {
namespace unity_guide_test {
namespace {

TEST(UnityGuide, TheScriptImportsWhatThePluginExports) {
  void* plugin = ::dlopen(VOYAGER_UNITY_PLUGIN, RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(plugin, nullptr) << ::dlerror();
  const std::string guide = file_bytes(VOYAGER_SOURCE_DIR "/docs/unity.md");
  const std::regex import(R"(\[DllImport\(Plugin\)\] static extern \w+ (\w+)\()");
  int imports = 0;
  for (std::sregex_iterator found(guide.begin(), guide.end(), import), end; found != end; ++found) {
    ++imports;
    EXPECT_NE(::dlsym(plugin, (*found)[1].str().c_str()), nullptr) << (*found)[1];
  }
  EXPECT_GE(imports, 5);
  ::dlclose(plugin);
}

}  // namespace
}  // namespace unity_guide_test
}  // namespace voyager::test
