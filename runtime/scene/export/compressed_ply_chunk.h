#pragma once
// A chunk of PlayCanvas' .compressed.ply: codes of up to 256 Gaussians, between the bounds that
// these have.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/scene/gaussian_cloud.h"

namespace voyager::compressed_ply {

inline constexpr size_t kChunkGaussians = 256;

// As the file has it.
struct Range {
  std::array<float, 3> least, most;
};
struct Bounds {
  Range position, log_scale, colour;
};
static_assert(sizeof(Bounds) == 72);

struct Vertex {
  uint32_t position;  // 11, 10 and 11 bits between the chunk's bounds, x in the highest
  uint32_t rotation;  // which of w, x, y, z is the largest in two bits, ten for each of the others
  uint32_t scale;     // as position
  uint32_t colour;    // r, g, b between the chunk's bounds, opacity from 0 to 1, 8 bits each
};
static_assert(sizeof(Vertex) == 16);

struct Chunk {
  Bounds bounds;
  std::vector<Vertex> vertices;
};

// Of the Gaussians with these indices, 1 to 256.
Chunk encode_chunk(const GaussianCloud& cloud, std::span<const uint32_t> indices);

// Of a coefficient of degree 1 or more: steps of 1/32 from -4 to 4.
uint8_t sh_code(float coefficient);

}  // namespace voyager::compressed_ply
