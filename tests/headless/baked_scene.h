#pragma once
// A small scene as the command line bakes it.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "library.h"
#include "scene_bytes.h"

// The bytes of the .voy of ply_bytes(gaussians), baked once for all tests. Not from two threads.
inline const std::string& baked_bytes(int gaussians) {
  static std::map<int, std::string> known;
  const auto [entry, is_new] = known.try_emplace(gaussians);
  if (!is_new) return entry->second;
  std::string folder = (std::filesystem::temp_directory_path() / "voyager-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return entry->second;
  const std::string ply = folder + "/scene.ply", voy = folder + "/scene.voy";
  std::ofstream(ply, std::ios::binary) << ply_bytes(gaussians);
  const std::string command =
      std::string(VOYAGER_TOOL) + " bake " + ply + " -o " + voy + " >/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::ifstream file(voy, std::ios::binary);
  entry->second.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  std::filesystem::remove_all(folder);
  return entry->second;
}
