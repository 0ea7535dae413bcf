#pragma once
// glTF's binary container: a header, the JSON, one binary chunk.
#include <cstdint>
#include <string>

#include "runtime/base/error.h"
#include "runtime/scene/export/writer.h"

namespace voyager::glb {

inline constexpr uint32_t kMagic = 0x46546c67, kVersion = 2;                   // "glTF"
inline constexpr uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;  // "JSON", "BIN"
inline constexpr uint64_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

// Where the binary chunk's bytes start, after so many of JSON, a multiple of four.
constexpr uint64_t binary_at(uint64_t json_bytes) {
  return kHeaderBytes + 2 * kChunkHeaderBytes + json_bytes;
}

// What stands before the binary chunk's bytes; the text is filled up with spaces.
inline void write_head(ByteSink& sink, std::string text, uint64_t json_bytes,
                       uint64_t binary_bytes) {
  text.resize(json_bytes, ' ');
  const auto u32 = [](uint64_t value) { return static_cast<uint32_t>(value); };
  const uint32_t begin[] = {kMagic, kVersion, u32(binary_at(json_bytes) + binary_bytes),
                            u32(json_bytes), kJsonChunk};
  const uint32_t binary[] = {u32(binary_bytes), kBinaryChunk};
  sink.write(std::as_bytes(std::span(begin)));
  sink.write(std::as_bytes(std::span(text)));
  sink.write(std::as_bytes(std::span(binary)));
}

}  // namespace voyager::glb
