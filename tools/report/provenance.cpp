#include "tools/report/provenance.h"

#include <fmt/core.h>
#include <sys/utsname.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>

#include "runtime/base/checksum.h"
#include "runtime/base/file.h"
#include "runtime/base/open_source.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// What follows "key ... : ", of the first line that begins with the key.
std::string value_in(const char* path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) {
      const size_t colon = line.find(':');
      if (colon != std::string::npos && colon + 2 <= line.size()) return line.substr(colon + 2);
    }
  return "";
}

Json known(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

Json machine() {
  utsname system{};
  uname(&system);
  return {{"processor", known(value_in("/proc/cpuinfo", "model name"))},
          {"threads", std::thread::hardware_concurrency()},
          {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
          {"gpu_driver", known(value_in("/proc/driver/nvidia/version", "NVRM version"))}};
}

}  // namespace

Json file_identity(const ByteSource& source) {
  constexpr uint64_t kBlock = 1 << 20;
  std::vector<std::byte> block(kBlock);
  std::vector<uint64_t> sums;
  for (uint64_t at = 0; at < source.size(); at += kBlock) {
    const auto part = std::span(block).first(std::min(kBlock, source.size() - at));
    source.read(at, part);
    sums.push_back(checksum(part));
  }
  const uint64_t sum = checksum(std::as_bytes(std::span(sums)));
  return {{"name", std::filesystem::path(source.name()).filename().string()},
          {"bytes", source.size()},
          {"xxh3", fmt::format("{:016x}", sum)}};
}

Json provenance(const std::string& scene, const std::string& cameras, const Backend& backend,
                const std::vector<std::string>& arguments) {
  return {{"scene", file_identity(*open_source(scene))},
          {"cameras", file_identity(*open_file_source(cameras))},
          {"version", VOYAGER_VERSION},
          {"source", known(VOYAGER_SOURCE)},
          {"device", backend.device_name()},
          {"machine", machine()},
          {"arguments", arguments}};
}

}  // namespace voyager::tools
