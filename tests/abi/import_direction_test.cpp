// Imports point one way. Static libraries would link most imports upwards
// without a word, so the sources are read.
#include <gtest/gtest.h>

#include <map>

#include "includes.h"

namespace {

using Folders = std::set<std::string>;

// What each folder of the runtime may include, besides itself.
const std::map<std::string, Folders>& allowed() {
  static const Folders below_backends = {"math",   "base",   "scene",  "lod",
                                         "format", "select", "stages", "frame"};
  static const std::map<std::string, Folders> table = {
      {"math", {}},
      {"base", {"math"}},
      {"scene", {"math", "base"}},
      {"lod", {"math", "base", "scene"}},
      {"format", {"math", "base", "scene", "lod"}},
      {"select", {"math", "base", "scene", "lod"}},
      {"stages", {"math", "base", "scene", "lod"}},
      {"frame", {"math", "base", "scene", "lod", "format", "select", "stages"}},
      {"cpu", below_backends},
      {"reference", below_backends},
  };
  return table;
}

TEST(ImportDirection, RuntimeFoldersImportDownwardsOnly) {
  const std::regex path_pattern(R"(^runtime/([a-z_]+)/)");
  size_t seen = 0;
  for (const Include& include : includes_below("runtime")) {
    std::smatch from, to;
    ASSERT_TRUE(std::regex_search(include.file, from, path_pattern)) << include.file;
    if (!std::regex_search(include.name, to, path_pattern)) continue;
    ++seen;
    const std::string folder = from[1].str(), imported = to[1].str();
    const auto row = allowed().find(folder);
    ASSERT_NE(row, allowed().end()) << include.file << ": the folder has no row in this test";
    EXPECT_TRUE(imported == folder || row->second.count(imported) == 1)
        << include.file << " includes " << include.name;
  }
  EXPECT_GT(seen, 50u);
}

TEST(ImportDirection, RuntimeKnowsNoAbiNoGpuAndNoVulkan) {
  const std::regex forbidden(R"(^(plugin|voyager|cuda|vulkan|vulkan_interop|openxr|tools|samples)/)"
                             R"(|^cuda|^vulkan|^openxr)");
  for (const Include& include : includes_below("runtime"))
    EXPECT_FALSE(std::regex_search(include.name, forbidden))
        << include.file << " includes " << include.name;
}

TEST(ImportDirection, PluginIncludesNothingAboveIt) {
  const std::regex forbidden(R"(^(tools|samples|tests|bench|cuda)/)");
  for (const Include& include : includes_below("plugin"))
    EXPECT_FALSE(std::regex_search(include.name, forbidden))
        << include.file << " includes " << include.name;
}

// A host has voyager/*.h, and so do our examples of hosts.
TEST(ImportDirection, HostsIncludeOnlyThePublicHeaders) {
  for (const char* folder : {"samples", "tests/headless"}) {
    size_t ours = 0;
    for (const Include& include : includes_below(folder)) {
      ours += include.name.rfind("voyager/", 0) == 0;
      const bool local = std::filesystem::exists(std::filesystem::path(VOYAGER_SOURCE_DIR) /
                                                 include.file / ".." / include.name);
      const bool in_tree =
          std::filesystem::exists(std::filesystem::path(VOYAGER_SOURCE_DIR) / include.name);
      EXPECT_TRUE(!in_tree || local) << include.file << " includes " << include.name;
      EXPECT_EQ(include.name.find(".."), std::string::npos) << include.file;
    }
    EXPECT_GT(ours, 0u) << folder;
  }
}

}  // namespace
