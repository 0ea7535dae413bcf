// The addon's scripts call what the extension registers, and name what each other has.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

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

// A member that a script names of an object: a call, or else a property or a signal.
struct Use {
  std::string member;
  bool call;
  size_t arguments;  // of a call
};

std::vector<Use> uses_of(const std::string& script, const std::string& object) {
  std::vector<Use> found;
  const std::regex wanted("\\b" + object + "\\.(\\w+)(\\(?)");
  for (std::sregex_iterator at(script.begin(), script.end(), wanted), end; at != end; ++at) {
    const bool call = (*at)[2].length() == 1;
    const auto behind = static_cast<size_t>(at->position() + at->length());
    found.push_back({(*at)[1], call, call ? count_arguments(script, behind) : 0});
  }
  return found;
}

TEST(GodotScripts, CallWhatTheExtensionRegisters) {
  const ImitatedGodot godot;
  const std::string script = addon("voyager_effect.gd");
  ASSERT_NE(script.find("var _splats := VoyagerSplats.new()"), std::string::npos);
  const auto uses = uses_of(script, "_splats");
  EXPECT_GE(uses.size(), 3u);
  for (const Use& use : uses) {
    EXPECT_TRUE(use.call) << use.member << ": no property and no signal is registered";
    ASSERT_TRUE(godot.has_method(use.member)) << use.member;
    EXPECT_EQ(use.arguments, godot.argument_count(use.member)) << use.member;
  }
}

TEST(GodotScripts, CallAndReadWhatTheEffectHas) {
  const std::string effect = addon("voyager_effect.gd");
  const auto variables = all_of(effect, "\\bvar (\\w+)");
  const auto uses = uses_of(addon("voyager_splats.gd"), "effect");
  EXPECT_GE(uses.size(), 3u);
  for (const Use& use : uses) {
    if (!use.call) {
      EXPECT_EQ(variables.count(use.member), 1u) << use.member;
      continue;
    }
    const std::string head = "func " + use.member + "(";
    const size_t function = effect.find(head);
    ASSERT_NE(function, std::string::npos) << use.member;
    EXPECT_EQ(use.arguments, count_arguments(effect, function + head.size())) << use.member;
  }
}

TEST(GodotScripts, NameClassesThatThereAre) {
  const ImitatedGodot godot;
  const std::string scripts = addon("voyager_splats.gd") + addon("voyager_effect.gd");
  const auto of_scripts = all_of(scripts, "class_name (\\w+)");
  const auto named = all_of(scripts, "\\b(Voyager\\w+)");
  EXPECT_GE(named.size(), 2u);
  for (const std::string& name : named)
    EXPECT_TRUE(godot.has_class(name) || of_scripts.count(name) == 1) << name;
}

TEST(GodotScripts, SetUniformsThatTheShaderHas) {
  const auto uniforms = all_of(addon("splats.gdshader"), "uniform \\w+ (\\w+)"),
             set = all_of(addon("voyager_splats.gd"), "set_shader_parameter\\(\"(\\w+)\"");
  EXPECT_GE(set.size(), 2u);
  for (const std::string& name : set) EXPECT_EQ(uniforms.count(name), 1u) << name;
}

}  // namespace
}  // namespace godot_scripts_test
}  // namespace voyager::test
