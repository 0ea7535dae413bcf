// A host compiled against this minor version's header keeps working: no field
// moves, no struct changes its size.
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "layout_c99.h"

namespace layout_test {
namespace {

std::string measured() {
  std::ostringstream out;
  for (size_t i = 0; i < kLayoutCount; ++i) {
    const LayoutRow& row = kLayout[i];
    if (*row.field == '\0')
      out << row.structure << ' ' << row.size << '\n';
    else
      out << "  " << row.field << ' ' << row.offset << ' ' << row.size << '\n';
  }
  return out.str();
}

std::string baseline() {
  std::ifstream file(VOYAGER_SOURCE_DIR "/tests/abi/layout.txt");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Layout, EqualsTheBaseline) {
  EXPECT_EQ(measured(), baseline()) << "struct, size; then field, offset, size. If the change is "
                                       "meant, it is a new API version: write layout.txt anew";
}

std::string headers() {
  std::ostringstream text;
  for (const char* name : {"voyager.h", "voyager_vulkan.h", "voyager_experiment.h"})
    text
        << std::ifstream(VOYAGER_SOURCE_DIR "/plugin/include/voyager/" + std::string(name)).rdbuf();
  return std::regex_replace(text.str(), std::regex(R"(/\*[^*]*\*+([^/*][^*]*\*+)*/)"), "");
}

// VoyFrameEye -> FRAME_EYE
std::string capitals(const std::string& structure) {
  std::string out;
  for (const char c : structure.substr(3)) {
    if (std::isupper(c) && !out.empty()) out += '_';
    out += static_cast<char>(std::toupper(c));
  }
  return out;
}

TEST(Layout, TheTableHasEveryFieldOfEveryStructure) {
  std::set<std::string> rows;
  for (size_t i = 0; i < kLayoutCount; ++i)
    rows.insert(std::string(kLayout[i].structure) + "." + kLayout[i].field);
  const std::string text = headers();
  const std::regex structure(R"(typedef struct (Voy\w+) \{([^}]*)\})"),
      field(R"((\w+)(\[\w+\])?[,;]|\(VOY_CALL\* ?(\w+)\))");
  size_t fields = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), structure), end; at != end; ++at) {
    const std::string name = (*at)[1],
                      body = std::regex_replace((*at)[2].str(), std::regex(R"(\)\([^)]*\);)"),
                                                ")");  // parameters of callbacks
    EXPECT_EQ(rows.count(name + "."), 1u) << name;
    for (std::sregex_iterator of(body.begin(), body.end(), field); of != end; ++of, ++fields) {
      const std::string member = (*of)[1].matched ? (*of)[1] : (*of)[3];
      EXPECT_EQ(rows.count(name + "." + member), 1u) << name << "." << member;
    }
  }
  EXPECT_GT(fields, 300u);
}

TEST(Layout, EveryStructureWithATypeHasAnInitialiser) {
  const std::string text = headers();
  const std::regex structure(R"(typedef struct (Voy\w+) \{\s*VoyStructureType type;)");
  size_t structures = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), structure), end; at != end; ++at) {
    const std::string name = capitals((*at)[1]);
    const std::regex macro("#define VOY_" + name + R"(_INIT[\s\\]*\{[\s\\]*VOY_STRUCTURE_TYPE_)" +
                           name + ", NULL");
    EXPECT_TRUE(std::regex_search(text, macro)) << (*at)[1];
    ++structures;
  }
  EXPECT_EQ(structures, 40u);
}

}  // namespace
}  // namespace layout_test
