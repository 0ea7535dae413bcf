#pragma once
// What readers and writers of KHR_gaussian_splatting agree on.
#include <cstdint>

#include "runtime/math/half_turn.h"

namespace voyager::gltf {

// glTF's axes are left-up-front, INRIA's right-down-front.
inline constexpr HalfTurn kToInria = kHalfTurnZ;

// The binary container: a header, then chunks, of which the first is the JSON.
inline constexpr uint32_t kMagic = 0x46546c67, kVersion = 2;                   // "glTF"
inline constexpr uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;  // "JSON", "BIN"
inline constexpr uint64_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

inline constexpr const char* kSplatting = "KHR_gaussian_splatting";
// A former name of the draft, and its name now.
inline constexpr const char* kSpz1 = "KHR_gaussian_splatting_compression_spz";
inline constexpr const char* kSpz2 = "KHR_gaussian_splatting_compression_spz_2";

}  // namespace voyager::gltf
