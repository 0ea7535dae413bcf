#pragma once
// Files whole, and images to files: each appears under its name only when complete.
#include <cstdint>
#include <span>
#include <string>

namespace host {

// All of it. Throws Failure(kRefusedInput) with the path.
std::string read_file(const std::string& path);

void write_file(const std::string& path, std::span<const std::byte> bytes);
// RGB from rows of RGBA.
void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgba);
// `Pf`: little-endian, bottom row first.
void write_pfm(const std::string& path, uint32_t width, uint32_t height,
               std::span<const float> values);

}  // namespace host
