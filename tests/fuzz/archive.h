#pragma once
// A folder of files as one input. Each file is the length of its name in a byte, its name, the
// length of its bytes in four, and its bytes. What is cut off is shorter.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace voyager::fuzz {

struct NamedFile {
  std::string name;
  std::vector<std::byte> bytes;
};

inline std::vector<NamedFile> unpacked(std::span<const std::byte> input) {
  const auto take = [&](size_t count) {
    const auto taken = input.first(std::min(count, input.size()));
    input = input.subspan(taken.size());
    return taken;
  };
  std::vector<NamedFile> files;
  while (!input.empty()) {
    const auto name = take(std::to_integer<size_t>(take(1)[0]));
    const auto length = take(sizeof(uint32_t));
    uint32_t count = 0;
    std::memcpy(&count, length.data(), length.size());
    const auto bytes = take(count);
    files.push_back({std::string(reinterpret_cast<const char*>(name.data()), name.size()),
                     {bytes.begin(), bytes.end()}});
  }
  return files;
}

inline std::vector<std::byte> packed(const std::vector<NamedFile>& files) {
  std::vector<std::byte> all;
  const auto add = [&](const void* from, size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    all.insert(all.end(), first, first + count);
  };
  for (const NamedFile& file : files) {
    const auto name = static_cast<uint8_t>(std::min<size_t>(file.name.size(), UINT8_MAX));
    const auto count = static_cast<uint32_t>(file.bytes.size());
    add(&name, sizeof name), add(file.name.data(), name);
    add(&count, sizeof count), add(file.bytes.data(), file.bytes.size());
  }
  return all;
}

}  // namespace voyager::fuzz
