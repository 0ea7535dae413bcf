#pragma once
// What the .spz reader and writer agree on.
#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/math/half_turn.h"
#include "runtime/math/sh.h"

namespace voyager::spz {

inline constexpr uint32_t kMagic = 0x5053474e;  // "NGSP"
inline constexpr uint8_t kFlagAntialiased = 1, kFlagExtensions = 2;
inline constexpr size_t kHeaderBytes = 16;         // v1-v3
inline constexpr size_t kStreamsHeaderBytes = 32;  // v4
inline constexpr size_t kTableEntryBytes = 16;     // compressed size, uncompressed size

enum Attribute { kPositions, kAlphas, kColours, kScales, kRotations, kSh, kAttributes };
inline constexpr std::array<const char*, kAttributes> kAttributeName = {
    "positions", "alphas", "colours", "scales", "rotations", "sh"};

// Bytes a Gaussian.
constexpr size_t width(Attribute attribute, uint32_t version, int sh_degree) {
  switch (attribute) {
    case kPositions:
      return version == 1 ? 6 : 9;
    case kAlphas:
      return 1;
    case kRotations:
      return version < 3 ? 3 : 4;
    case kSh:
      return static_cast<size_t>(sh_coefficients(sh_degree) - 1) * 3;
    default:
      return 3;
  }
}

// SPZ's axes are right-up-back, INRIA's right-down-front.
inline constexpr HalfTurn kToInria = kHalfTurnX;

inline constexpr float kColourScale = 0.15f;
inline constexpr int kRotationSteps = 511;  // of sqrt(1/2), in nine bits

}  // namespace voyager::spz
