// The script in docs/unity.md calls what the plugin exports.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/command_line/program.h"
#include "tests/support/count_arguments.h"

namespace voyager::test {
namespace unity_guide_test {
namespace {

TEST(UnityGuide, TheScriptImportsWhatThePluginExports) {
  void* plugin = ::dlopen(VOYAGER_UNITY_PLUGIN, RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(plugin, nullptr) << ::dlerror();
  const std::string guide = file_bytes(VOYAGER_SOURCE_DIR "/docs/unity.md");
  const std::string api = file_bytes(VOYAGER_SOURCE_DIR "/samples/unity_plugin/plugin_api.h");
  const std::regex import(R"(\[DllImport\(Plugin\)\] static extern \w+ (\w+)\()");
  int imports = 0;
  for (std::sregex_iterator found(guide.begin(), guide.end(), import), end; found != end; ++found) {
    ++imports;
    const std::string name = (*found)[1];
    EXPECT_NE(::dlsym(plugin, name.c_str()), nullptr) << name;
    const size_t declared = api.find(" " + name + "(");
    ASSERT_NE(declared, std::string::npos) << name;
    EXPECT_EQ(count_arguments(guide, static_cast<size_t>(found->position() + found->length())),
              count_arguments(api, declared + name.size() + 2))
        << name;
  }
  EXPECT_GE(imports, 5);
  ::dlclose(plugin);
}

}  // namespace
}  // namespace unity_guide_test
}  // namespace voyager::test
