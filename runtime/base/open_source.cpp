#include "runtime/base/open_source.h"

#include <array>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/base/http_module.h"
#include "runtime/base/module.h"
#include "runtime/base/url.h"

namespace voyager {
namespace {

std::unique_ptr<ByteSource> open_url(const std::string& url) {
  const auto* module = static_cast<const HttpModule*>(open_module(
      "http", kHttpModuleSymbol, module_stamp(sizeof(HttpModule)), ErrorCode::unsupported));
  ErrorCode code = ErrorCode::internal;
  std::array<char, 1024> message{};
  if (ByteSource* source = module->open(url.c_str(), &code, message.data(), message.size()))
    return std::unique_ptr<ByteSource>(source);
  throw Error(code, message.data());
}

}  // namespace

std::string scene_file(const std::string& path) {
  std::error_code ignored;
  if (is_url(path) || !std::filesystem::is_directory(path, ignored)) return path;
  for (const char* name : {"lod-meta.json", "meta.json", "tileset.json"}) {
    const std::filesystem::path file = std::filesystem::path(path) / name;
    if (std::filesystem::exists(file, ignored)) return file.string();
  }
  return path;
}

std::unique_ptr<ByteSource> open_source(const std::string& path) {
  if (is_url(path)) return open_url(path);
  const std::string file = scene_file(path);
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw Error(ErrorCode::refused_input,
                file +
                    ": found a directory, expected a file, or a folder with lod-meta.json, "
                    "meta.json or tileset.json");
  return open_file_source(file);
}

}  // namespace voyager
