// The addon's scripts call what the extension registers, and name what each other has.
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/command_line/program.h"
#include "tests/godot/imitated_godot.h"
#include "tests/support/count_arguments.h"

namespace voyager::test {
namespace godot_scripts_test {
namespace {

std::string addon(const std::string& name) {
  return file_bytes(VOYAGER_SOURCE_DIR "/samples/godot_extension/addon/" + name);
}

// The first group of each match.
std::set<std::string> all_of(const std::string& text, const std::string& pattern) {
  std::set<std::string> found;
  const std::regex wanted(pattern);
  for (std::sregex_iterator at(text.begin(), text.end(), wanted), end; at != end; ++at)
    found.insert((*at)[1]);
  return found;
}

TEST(GodotScripts, CallWhatTheExtensionRegisters) {
  const ImitatedGodot godot;
  const std::string script = addon("voyager_effect.gd");
  ASSERT_NE(script.find("var _splats := VoyagerSplats.new()"), std::string::npos);
  const std::regex call("_splats\\.(\\w+)\\(");
  int calls = 0;
  for (std::sregex_iterator at(script.begin(), script.end(), call), end; at != end; ++at, ++calls) {
    const std::string method = (*at)[1];
    const auto arguments = static_cast<size_t>(at->position() + at->length());
    ASSERT_TRUE(godot.has_method(method)) << method;
    EXPECT_EQ(count_arguments(script, arguments), godot.argument_count(method)) << method;
  }
  EXPECT_GE(calls, 3);
}

TEST(GodotScripts, NameWhatTheEffectAndTheShaderHave) {
  const std::string splats = addon("voyager_splats.gd"), effect = addon("voyager_effect.gd");
  const std::set<std::string> members = all_of(effect, "(?:func|var) (\\w+)"),
                              uniforms = all_of(addon("splats.gdshader"), "uniform \\w+ (\\w+)");
  const auto used = all_of(splats, "\\beffect\\.(\\w+)"),
             set = all_of(splats, "set_shader_parameter\\(\"(\\w+)\"");
  EXPECT_GE(used.size(), 3u);
  EXPECT_GE(set.size(), 2u);
  for (const std::string& name : used) EXPECT_EQ(members.count(name), 1u) << name;
  for (const std::string& name : set) EXPECT_EQ(uniforms.count(name), 1u) << name;
}

}  // namespace
}  // namespace godot_scripts_test
}  // namespace voyager::test
