// A host compiled against this minor version's header keeps working: no field
// moves, no struct changes its size.
#include <gtest/gtest.h>

#include <fstream>
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

}  // namespace
}  // namespace layout_test
