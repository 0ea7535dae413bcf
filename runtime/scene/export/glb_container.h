#pragma once
// glTF's binary container: a header, the JSON, one binary chunk.
#include <cstdint>
#include <string>

#include "runtime/base/error.h"
#include "runtime/scene/export/writer.h"
#include "runtime/scene/gltf_format.h"

namespace voyager::glb {

// Where the binary chunk's bytes start, after so many of JSON, a multiple of four.
constexpr uint64_t binary_at(uint64_t json_bytes) {
  return gltf::kHeaderBytes + 2 * gltf::kChunkHeaderBytes + json_bytes;
}

// What stands before the binary chunk's bytes; the text is filled up with spaces.
inline void write_head(ByteSink& sink, std::string text, uint64_t json_bytes,
                       uint64_t binary_bytes) {
  text.resize(json_bytes, ' ');
  const auto u32 = [](uint64_t value) { return static_cast<uint32_t>(value); };
  const uint32_t begin[] = {gltf::kMagic, gltf::kVersion, u32(binary_at(json_bytes) + binary_bytes),
                            u32(json_bytes), gltf::kJsonChunk};
  const uint32_t binary[] = {u32(binary_bytes), gltf::kBinaryChunk};
  sink.write(std::as_bytes(std::span(begin)));
  sink.write(std::as_bytes(std::span(text)));
  sink.write(std::as_bytes(std::span(binary)));
}

}  // namespace voyager::glb
