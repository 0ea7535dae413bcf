// On Windows the calling convention and the import are part of a declaration, and a library
// there could not add them later. So every function and every callback carries them today.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace voyager::calling_convention_test {
namespace {

// Both headers, comments and macros left out.
std::string declarations() {
  std::string text;
  for (const char* header : {"voyager.h", "voyager_vulkan.h"}) {
    std::ifstream file(std::string(VOYAGER_SOURCE_DIR "/plugin/include/voyager/") + header);
    text.append(std::istreambuf_iterator<char>(file), {});
  }
  text = std::regex_replace(text, std::regex(R"(/\*[^*]*\*+([^/*][^*]*\*+)*/)"), "");
  return std::regex_replace(text, std::regex(R"(#([^\n]*\\\n)*[^\n]*)"), "");
}

std::set<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex wanted(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), wanted), end; at != end; ++at)
    found.insert((*at)[1]);
  return found;
}

TEST(CallingConvention, EveryFunctionHasExportAndConvention) {
  const std::string text = declarations();
  const auto functions = matches(text, R"(\b(voy[A-Z]\w*)\()");
  EXPECT_GE(functions.size(), 30u);
  EXPECT_EQ(matches(text, R"(VOY_API [\w ]+\*? VOY_CALL (voy\w+)\()"), functions);
}

TEST(CallingConvention, EveryCallbackAndFunctionPointerHasConvention) {
  const std::string text = declarations();
  const auto pointers = matches(text, R"(\([\w ]*\* ?(\w+)\)\()");
  std::set<std::string> expected = {"VoyLogFunction", "allocate", "read", "deallocate"};
  for (const std::string& function : matches(text, R"(\b(voy[A-Z]\w*)\()"))
    expected.insert("PFN_" + function);
  EXPECT_EQ(pointers, expected);
  EXPECT_EQ(matches(text, R"(\(VOY_CALL\* ?(\w+)\)\()"), pointers);
}

}  // namespace
}  // namespace voyager::calling_convention_test
