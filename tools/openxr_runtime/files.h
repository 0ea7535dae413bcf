#pragma once
// Files that appear under their names only when complete. All throw std::runtime_error.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace test_runtime {

void write_bytes(const std::string& path, std::span<const std::byte> bytes);
void write_text(const std::string& path, const std::string& text);
// Rows of RGB from the top.
void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgb);
// `Pf`, little-endian, bottom row first; values are rows from the top.
void write_pfm(const std::string& path, uint32_t width, uint32_t height,
               std::span<const float> values);

}  // namespace test_runtime
