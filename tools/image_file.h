#pragma once
// Images to files. Each appears under its name only when complete.
#include <cstdint>
#include <span>
#include <string>

namespace voyager::tools {

// A PNG's bytes: RGB, 8 bits, from rows of RGBA.
std::string encode_png(uint32_t width, uint32_t height, std::span<const uint8_t> rgba);
void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgba);

// `PF` from rows of RGBA; `Pf` from one value a pixel. Little-endian, bottom row first.
void write_pfm_rgb(const std::string& path, uint32_t width, uint32_t height,
                   std::span<const float> rgba);
void write_pfm_grey(const std::string& path, uint32_t width, uint32_t height,
                    std::span<const float> values);

}  // namespace voyager::tools
