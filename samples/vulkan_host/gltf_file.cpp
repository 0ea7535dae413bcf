#include "gltf_file.h"

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "failure.h"
#include "files.h"

namespace host {
namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// tinygltf calls itself for each level. What is no JSON it says itself.
void check_nesting(const std::string& path, std::string_view json) {
  constexpr int kMostLevels = 256;
  using Json = nlohmann::json;
  const auto check_level = [&](int level, Json::parse_event_t, Json&) {
    if (level > kMostLevels)
      throw Failure(kRefusedInput, path + ": JSON: expected at most " +
                                       std::to_string(kMostLevels) + " levels in one another");
    return false;  // nothing is kept
  };
  [[maybe_unused]] const Json none = Json::parse(json, check_level, /*allow_exceptions=*/false);
}

// The first chunk of a .glb, or what there is of it.
std::string_view json_chunk(std::string_view glb) {
  constexpr size_t kLengthAt = 12, kBegin = 20;
  uint32_t length = 0;
  if (glb.size() < kBegin) return {};
  std::memcpy(&length, &glb[kLengthAt], sizeof length);
  return glb.substr(kBegin, length);
}

// A buffer in a file of its own.
bool read_buffer(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                 void* files) {
  try {
    static_cast<std::vector<std::string>*>(files)->push_back(path);
    const std::string bytes = read_file(path, kLargestMesh);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const Failure& failure) {
    *error += failure.what();
    return false;
  }
}

}  // namespace

tinygltf::Model read_gltf(const std::string& path, std::vector<std::string>& files) {
  files = {path};
  const std::string bytes = read_file(path, kLargestMesh);
  const auto size = static_cast<uint32_t>(bytes.size());
  const bool binary = path.ends_with(".glb");
  check_nesting(path, binary ? json_chunk(bytes) : bytes);

  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(
      {tinygltf::FileExists, tinygltf::ExpandFilePath, read_buffer, nullptr, &files});
  // Images are never looked at.
  loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                           const unsigned char*, int, void*) { return true; },
                        nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const bool loaded =
      binary ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                           reinterpret_cast<const unsigned char*>(bytes.data()),
                                           size, folder)
             : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  if (!loaded) throw Failure(kRefusedInput, path + ": expected glTF: " + first_line(error));
  return model;
}

}  // namespace host
