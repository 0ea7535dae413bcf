#pragma once
// Files whole, and images to files: each appears under its name only when complete.
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace host {

inline constexpr uint64_t kLargestCameras = 64'000'000, kLargestMesh = 1'000'000'000;  // bytes

// All of it. Throws Failure(kRefusedInput) with the path, also for more bytes than `most`, which
// are not read, and for what is no file: nothing waits for the other end of a pipe.
std::string read_file(const std::string& path, uint64_t most);

// Before the work: throws Failure(kMachine) where write_file() would fail.
void require_writable(const std::string& path);
// Throws Failure(kBadUsage) where `output` is one of the other files, whatever links lead there.
// Empty names do not count.
void require_distinct(const std::string& output, const std::vector<std::string>& others);
// Both, of the files in the folder whose names is_picture() accepts: pictures that are not there
// yet can be put there.
void require_pictures(const std::string& folder, const std::vector<std::string>& others,
                      const std::function<bool(std::string_view name)>& is_picture);
// Where `path` is a symbolic link, to what it leads to. Throws Failure(kMachine).
void write_file(const std::string& path, std::span<const std::byte> bytes);
// RGB from rows of RGBA.
void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgba);
// `Pf`: little-endian, bottom row first.
void write_pfm(const std::string& path, uint32_t width, uint32_t height,
               std::span<const float> values);

}  // namespace host
