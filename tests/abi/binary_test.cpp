// The shared library as the dynamic linker sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "elf.h"

namespace binary_test {
namespace {

std::vector<std::string> baseline() {
  std::ifstream file(VOYAGER_SOURCE_DIR "/tests/abi/exports.txt");
  std::vector<std::string> functions;
  for (std::string line; std::getline(file, line);) functions.push_back(line);
  return functions;
}

TEST(Binary, ExportsExactlyTheBaseline) {
  std::vector<std::string> found = ElfFile(VOYAGER_LIBRARY).exports();
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, baseline());
}

// header_cpp17.cpp holds each of these types to its function, by name.
TEST(Binary, EachExportHasATypeForLoadingAtRunTime) {
  const auto text = [](const std::string& path) {
    std::ifstream file(VOYAGER_SOURCE_DIR + path);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string headers =
      text("/plugin/include/voyager/voyager.h") + text("/plugin/include/voyager/voyager_vulkan.h");
  const std::string held = text("/tests/abi/header_cpp17.cpp");
  EXPECT_FALSE(baseline().empty());
  for (const std::string& function : baseline()) {
    EXPECT_NE(headers.find("PFN_" + function + ")"), std::string::npos) << function;
    EXPECT_NE(held.find("VOY_TEST_TYPE(" + function + ")"), std::string::npos) << function;
  }
}

// The number that hosts are served by: voyager.h, VOY_API_VERSION.
TEST(Binary, SonameIsTheSeriesOfHostsThatAreServed) {
  std::ifstream file(VOYAGER_SOURCE_DIR "/VERSION");
  std::string version;
  std::getline(file, version);
  const size_t dot = version[0] == '0' ? version.rfind('.') : version.find('.');
  const std::string expected = "libvoyager.so." + version.substr(0, dot);
  EXPECT_EQ(ElfFile(VOYAGER_LIBRARY).soname(), std::vector<std::string>{expected});
}

void expect_needs_none(const std::string& path, const std::vector<std::string>& forbidden) {
  const std::vector<std::string> needed = ElfFile(path).needed();
  EXPECT_FALSE(needed.empty()) << path;
  for (const std::string& library : needed)
    for (const std::string& name : forbidden)
      EXPECT_NE(library.rfind(name, 0), 0u) << path << " needs " << library;
}

TEST(Binary, LibraryNeedsNoDriverAndNoLoader) {
  expect_needs_none(VOYAGER_LIBRARY, {"libcuda", "libcudart", "libvulkan", "libopenxr", "libcurl"});
}

// A host that linked the library, or a part of it, would not show that dlopen is enough.
TEST(Binary, HostsThatLoadTheLibraryNeedNoneOfOurs) {
  for (const std::string host : {"c_minimal", "headless_tests"})
    expect_needs_none(VOYAGER_BIN_DIR "/" + host, {"libvoyager", "libtbb", "libcuda", "libcudart"});
}

std::vector<std::string> entries(const std::string& list) {
  std::vector<std::string> found(1);
  for (const char c : list)
    if (c == ':')
      found.emplace_back();
    else
      found.back() += c;
  return found;
}

// An empty entry of a run path is the current folder, in which anybody may have put a libzstd.so.1.
TEST(Binary, WhatIsShippedLooksForLibrariesBesideItselfAlone) {
  for (const std::string& path : entries(VOYAGER_SHIPPED)) {
    const std::vector<std::string> run_path = ElfFile(path).run_path();
    ASSERT_EQ(run_path.size(), 1u) << path;
    for (const std::string& entry : entries(run_path[0]))
      EXPECT_EQ(entry.rfind("$ORIGIN", 0), 0u) << path << ": " << run_path[0];
  }
}

}  // namespace
}  // namespace binary_test
