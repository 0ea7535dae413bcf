// The C and C++ of the documentation compiles against the headers, in what its page says it stands
// in.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <regex>

#include "tests/command_line/program.h"

namespace voyager::docs_snippets_test {
namespace {

using namespace voyager::test;
namespace fs = std::filesystem;

const std::string kSource = VOYAGER_SOURCE_DIR;

std::string compiler_of(const std::string& extension) {
  const std::string warnings =
      " -Wall -Wextra -pedantic -Werror -fsyntax-only -I" + kSource + "/plugin/include ";
  if (extension == "c") return VOYAGER_C_COMPILER " -std=c99" + warnings;
  return VOYAGER_CXX_COMPILER " -std=c++20 -fno-exceptions -fno-rtti" + warnings + "-I" + kSource +
         "/tests/unreal/stub -I" + kSource + "/samples/unreal_plugin/Source/Voyager/Public ";
}

// tests/docs/snippets has a file for each page with such code, which includes it as snippet.h.
TEST(DocsSnippets, EachCompilesInTheFileOfItsPage) {
  const fs::path folder =
      fs::path(::testing::TempDir()) / ("snippets-" + std::to_string(::getpid()));
  fs::create_directory(folder);
  const std::regex fence("\n *```(c|cpp)\n([^`]*)\n *```");
  int snippets = 0;
  for (const fs::directory_entry& page : fs::directory_iterator(kSource + "/docs")) {
    if (page.path().extension() != ".md") continue;
    const std::string text = file_bytes(page.path());
    for (std::sregex_iterator at(text.begin(), text.end(), fence), end; at != end; ++at) {
      ++snippets;
      const std::string extension = (*at)[1];
      const std::string around =
          kSource + "/tests/docs/snippets/" + page.path().stem().string() + "." + extension;
      write_bytes(folder / "snippet.h", (*at)[2].str() + "\n");
      const Outcome compiled =
          run_shell(compiler_of(extension) + "-I" + folder.string() + " " + around);
      EXPECT_EQ(compiled.exit_code, 0) << page.path() << "\n" << compiled.output;
    }
  }
  EXPECT_GE(snippets, 3);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace voyager::docs_snippets_test
