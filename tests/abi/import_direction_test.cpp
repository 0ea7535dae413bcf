// Imports point one way. Static libraries would link most imports upwards
// without a word, so the sources are read.
#include <gtest/gtest.h>

#include <map>

#include "includes.h"

namespace import_direction_test {
namespace {

using Folders = std::set<std::string>;

// What each folder of the runtime may include, besides itself.
const std::map<std::string, Folders>& allowed() {
  static const Folders below_backends = {"math",   "base",   "scene",  "lod",  "format",
                                         "select", "stages", "stream", "frame"};
  static const std::map<std::string, Folders> table = {
      {"math", {}},
      {"base", {"math"}},
      {"scene", {"math", "base"}},
      {"lod", {"math", "base", "scene"}},
      {"format", {"math", "base", "scene", "lod"}},
      {"bake", {"math", "base", "scene", "lod", "format"}},
      {"select", {"math", "base", "scene", "lod"}},
      {"stages", {"math", "base", "scene", "lod"}},
      {"refine", {"math", "base", "scene", "lod", "bake", "select", "stages"}},
      {"stream", {"math", "base", "scene", "lod", "format", "select"}},
      {"frame", {"math", "base", "scene", "lod", "format", "select", "stages", "stream"}},
      {"optimize", {"math", "base", "scene", "lod", "bake", "refine", "select", "stages", "frame"}},
      {"cpu", below_backends},
      {"reference", below_backends},
  };
  return table;
}

bool starts_with_any(const std::string& name, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes)
    if (name.rfind(prefix, 0) == 0) return true;
  return false;
}

// "scene" of "runtime/scene/import/ply.cpp"; "" for other paths.
std::string runtime_folder(const std::string& path) {
  const std::string root = "runtime/";
  if (path.rfind(root, 0) != 0) return "";
  return path.substr(root.size(), path.find('/', root.size()) - root.size());
}

TEST(ImportDirection, RuntimeFoldersImportDownwardsOnly) {
  size_t seen = 0;
  for (const Include& include : includes_below("runtime")) {
    const std::string folder = runtime_folder(include.file);
    const std::string imported = runtime_folder(include.name);
    if (imported.empty()) continue;
    ++seen;
    const auto row = allowed().find(folder);
    ASSERT_NE(row, allowed().end()) << include.file << ": the folder has no row in this test";
    EXPECT_TRUE(imported == folder || row->second.count(imported) == 1)
        << include.file << " includes " << include.name;
  }
  EXPECT_GT(seen, 50u);
}

void expect_no_include(const char* folder, const std::vector<std::string>& forbidden) {
  for (const Include& include : includes_below(folder))
    EXPECT_FALSE(starts_with_any(include.name, forbidden))
        << include.file << " includes " << include.name;
}

TEST(ImportDirection, RuntimeKnowsNoAbiNoGpuAndNoVulkan) {
  expect_no_include("runtime",
                    {"plugin/", "voyager/", "tools/", "samples/", "cuda", "vulkan", "openxr"});
}

TEST(ImportDirection, PluginIncludesNothingAboveIt) {
  expect_no_include("plugin", {"tools/", "samples/", "tests/", "bench/", "cuda"});
}

// A module: it knows the runtime, and nothing that loads it.
TEST(ImportDirection, CudaImportsTheRuntimeOnly) {
  expect_no_include("cuda", {"plugin/", "voyager/", "tools/", "samples/", "tests/", "bench/",
                             "runtime/cpu/", "runtime/reference/"});
}

TEST(ImportDirection, HttpImportsTheBaseOnly) {
  expect_no_include("http",
                    {"plugin/", "voyager/", "tools/", "samples/", "tests/", "bench/", "cuda"});
  for (const Include& include : includes_below("http"))
    EXPECT_TRUE(include.name.rfind("runtime/", 0) != 0 ||
                include.name.rfind("runtime/base/", 0) == 0)
        << include.file << " includes " << include.name;
}

TEST(ImportDirection, OnlyTheHttpModuleKnowsLibcurl) {
  for (const char* folder : {"runtime", "plugin", "tools", "host", "samples", "cuda"})
    expect_no_include(folder, {"http/", "curl/"});
}

TEST(ImportDirection, OnlyTheSogModuleKnowsLibwebpAndLibzip) {
  const std::vector<std::string> its_own = {"webp/", "zip.h", "runtime/scene/import/sog/",
                                            "runtime/scene/export/sog/"};
  expect_no_include(
      "sog", {"plugin/", "voyager/", "tools/", "samples/", "tests/", "bench/", "cuda", "http/"});
  for (const char* folder : {"runtime", "plugin", "tools", "host", "samples", "cuda"})
    for (const Include& include : includes_below(folder)) {
      if (include.file.rfind("runtime/scene/import/sog/", 0) == 0 ||
          include.file.rfind("runtime/scene/export/sog/", 0) == 0)
        continue;
      EXPECT_FALSE(starts_with_any(include.name, its_own))
          << include.file << " includes " << include.name;
    }
}

TEST(ImportDirection, OnlyTheModuleIncludesCuda) {
  for (const char* folder : {"tools", "host", "samples"})
    expect_no_include(folder, {"cuda/", "cuda", "cub/"});
  // What measures the device itself is CUDA's own code.
  for (const Include& include : includes_below("bench")) {
    if (include.file.ends_with(".cu")) continue;
    EXPECT_FALSE(starts_with_any(include.name, {"cuda/", "cuda", "cub/"}))
        << include.file << " includes " << include.name;
  }
}

// The hand-off knows file descriptors, Vulkan and what an image is: no scene, no backend.
TEST(ImportDirection, VulkanInteropKnowsNoScenesAndNoBackend) {
  const std::vector<std::string> images = {"runtime/frame/image.h",
                                           "runtime/frame/external_ring.h"};
  std::vector<std::string> allowed = {"runtime/base/", "runtime/math/"};
  allowed.insert(allowed.end(), images.begin(), images.end());
  expect_no_include("vulkan_interop", {"plugin/", "voyager/", "tools/", "samples/", "tests/",
                                       "bench/", "cuda", "openxr"});
  size_t seen = 0;
  for (const char* folder : {"vulkan_interop", "runtime/frame"})
    for (const Include& include : includes_below(folder)) {
      const bool counts =
          include.file.rfind("vulkan_interop/", 0) == 0 || starts_with_any(include.file, images);
      if (!counts || include.name.rfind("runtime/", 0) != 0) continue;
      ++seen;
      EXPECT_TRUE(starts_with_any(include.name, allowed))
          << include.file << " includes " << include.name;
    }
  EXPECT_GT(seen, 10u);
}

// A host has voyager/*.h, and so do our examples of hosts.
TEST(ImportDirection, HostsIncludeOnlyThePublicHeaders) {
  for (const char* folder : {"host", "samples", "tests/headless"}) {
    size_t ours = 0;
    for (const Include& include : includes_below(folder)) {
      ours += include.name.rfind("voyager/", 0) == 0;
      if (include.name == "tests/support/needs.h") continue;  // GoogleTest's words, none of ours
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
}  // namespace import_direction_test
