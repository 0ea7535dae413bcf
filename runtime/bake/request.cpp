#include <sys/stat.h>

#include <filesystem>
#include <set>
#include <span>

#include "runtime/bake/bake.h"
#include "runtime/bake/files_beside.h"
#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/base/url.h"

namespace voyager {
namespace {

constexpr int kWorkVersion = 9;  // of the files in the folder

std::string state_of(const std::string& path) {
  struct stat info = {};
  if (::stat(path.c_str(), &info) != 0)
    throw Error(ErrorCode::file_not_found, path + ": not found");
  const uint64_t nanoseconds = static_cast<uint64_t>(info.st_mtim.tv_sec) * 1000000000u +
                               static_cast<uint64_t>(info.st_mtim.tv_nsec);
  return std::filesystem::absolute(path).string() + " of " + std::to_string(info.st_size) +
         " bytes, changed at " + std::to_string(nanoseconds) + "\n";
}

// There may be very many.
std::string line_of_beside(const std::set<std::string>& files) {
  if (files.empty()) return {};
  RunningChecksum states;
  for (const std::string& file : files) {
    const std::string state = state_of(file);
    states.add(std::as_bytes(std::span(state)));
  }
  return "files that it refers to: " + std::to_string(files.size()) +
         ", checksum of their names, sizes and times " + std::to_string(states.value()) + "\n";
}

std::string line_of(const std::string& path) {
  if (path == "-") return "input standard input\n";
  if (is_url(path))
    return "input " + shown_path(path) + " of " + std::to_string(open_source(path)->size()) +
           " bytes, its URL's checksum " +
           std::to_string(checksum(std::as_bytes(std::span(path)))) + "\n";
  return "input " + state_of(scene_file(path)) + line_of_beside(files_beside(path));
}

}  // namespace

std::string bake_request(const std::vector<std::string>& inputs, Quality quality,
                         uint32_t chunk_bytes, const TreeRule& rule, const NativeChoice& native) {
  std::string text = "work folder version " + std::to_string(kWorkVersion) + "\n.voy version " +
                     std::to_string(kSceneVersion) + "\nquality " +
                     (quality == Quality::compact ? "compact" : "lossless") + "\nchunk bytes " +
                     std::to_string(chunk_bytes) + "\nblocks of " + std::to_string(rule.block) +
                     " and " + std::to_string(rule.exposure_block) + "\n";
  text += request_line(native);
  for (const std::string& input : inputs) text += line_of(input);
  return text;
}

}  // namespace voyager
